// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_planes.h"

#include <algorithm>
#include <bit>

#include "slf/given_planes.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPlaneGrain = 4096;  // points

/// Rounded mean of channel c of `views` colours.
std::uint8_t mean_of_views(const std::uint8_t* first, std::size_t views, std::size_t c) {
  unsigned sum = 0;
  for (std::size_t v = 0; v < views; ++v) sum += first[3 * v + c];
  const auto n = static_cast<unsigned>(views);
  return static_cast<std::uint8_t>((sum + n / 2) / n);
}

}  // namespace

bool own_is_mean(const PlenopticCloud& cloud) {
  if (!cloud.own_colour) return false;
  const std::size_t row = 3 * cloud.num_colours();
  for (std::size_t at = 0; at < cloud.colours.size(); at += row)
    for (std::size_t c = 0; c < 3; ++c)
      if (cloud.colours[at + c] != mean_of_views(&cloud.colours[at + 3], cloud.views, c))
        return false;
  return true;
}

LightField field_of_planes(const PlenopticCloud& cloud, const PlenopticRecord& record, int shift) {
  LightField field;
  const std::size_t all = cloud.num_colours(), skip = record.mean ? 1 : 0, coded = all - skip;
  LightFieldHeader& header = field.header;
  header.grid = cloud.grid;
  header.has_basis = false;
  header.num_functions = static_cast<int>(coded);
  header.shift.assign(coded, shift);
  field.positions = cloud.positions;
  field.components.resize(cloud.num_points() * 3 * coded);
  for (std::size_t p = 0; p < cloud.num_points(); ++p)
    for (std::size_t j = 0; j < 3 * coded; ++j)
      field.components[p * 3 * coded + j] = cloud.colours[p * 3 * all + 3 * skip + j] << shift;
  return field;
}

std::vector<std::uint8_t> coded_bytes(const PlenopticCloud& cloud, const PlenopticRecord& record) {
  if (!record.mean) return cloud.colours;
  std::vector<std::uint8_t> bytes;
  const std::size_t row = 3 * cloud.num_colours();
  bytes.reserve(cloud.num_points() * (row - 3));
  for (std::size_t at = 0; at < cloud.colours.size(); at += row)
    bytes.insert(bytes.end(), cloud.colours.begin() + static_cast<std::ptrdiff_t>(at + 3),
                 cloud.colours.begin() + static_cast<std::ptrdiff_t>(at + row));
  return bytes;
}

std::vector<std::uint8_t> bytes_of_planes(const LightField& field, int threads) {
  const auto functions = static_cast<std::size_t>(field.header.num_functions);
  const std::vector<int>& shift = field.header.shift;
  const std::vector<std::int32_t> planes = given_planes(field, threads);
  std::vector<std::uint8_t> bytes(planes.size());
  parallel_ranges(field.num_points(), kPlaneGrain, threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin * 3 * functions; i < end * 3 * functions; ++i) {
                      const int s = shift[i / 3 % functions];
                      const std::int64_t half = s > 0 ? std::int64_t{1} << (s - 1) : 0;
                      const std::int64_t grey = (planes[i] + half) >> s;
                      bytes[i] = static_cast<std::uint8_t>(std::clamp<std::int64_t>(grey, 0, 255));
                    }
                  });
  return bytes;
}

void set_colours(std::vector<std::uint8_t> coded, const PlenopticRecord& record,
                 PlenopticCloud& cloud) {
  if (!record.mean) {
    cloud.colours = std::move(coded);
    return;
  }
  const std::size_t views = 3 * cloud.views, row = views + 3;
  cloud.colours.resize(cloud.num_points() * row);
  for (std::size_t p = 0; p < cloud.num_points(); ++p) {
    const std::uint8_t* from = &coded[p * views];
    std::uint8_t* to = &cloud.colours[p * row];
    for (std::size_t c = 0; c < 3; ++c) to[c] = mean_of_views(from, cloud.views, c);
    std::copy(from, from + views, to + 3);
  }
}

}  // namespace slf
