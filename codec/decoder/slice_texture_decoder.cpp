// SPDX-License-Identifier: Apache-2.0
// Components of a slice whose planes are pictures. Spec 8.11.
#include <optional>

#include "attributes/texture/texture_decoder.h"
#include "codec/decoder/slice_decoder.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// sum / n to nearest, halves away from zero. |sum| < 2^52.
std::int32_t rounded_mean(std::int64_t sum, std::int64_t n) {
  const std::int64_t magnitude = ((sum < 0 ? -sum : sum) + n / 2) / n;
  return static_cast<std::int32_t>(sum < 0 ? -magnitude : magnitude);
}

/// Values of the points to those of the kept rows, in column `plane` of `components`.
void store_plane(std::span<const std::int32_t> values, std::span<const std::uint32_t> first,
                 std::size_t plane, std::size_t planes, std::span<std::int32_t> components) {
  for (std::size_t row = 0; row + 1 < first.size(); ++row) {
    std::int64_t sum = 0;
    for (std::size_t p = first[row]; p < first[row + 1]; ++p) sum += values[p];
    components[row * planes + plane] = rounded_mean(sum, first[row + 1] - first[row]);
  }
}

}  // namespace

Result<Done> decode_slice_texture(const SliceToDecode& slice, const SliceGeometry& geometry,
                                  std::span<std::int32_t> components, int threads) {
  const Request& request = slice.request;
  const SequenceParameterSet& set = request.stream.set;
  std::vector<const PartUnit*> wanted;  // by group
  for (const PartUnit& unit : slice.units)
    if (has_values(unit.type) && request.wants(slot_of(unit.type, unit.header)))
      wanted.push_back(&unit);
  if (wanted.empty()) return Done{};
  SLF_TRY(const Atlas atlas,
          in_unit(*wanted.front(), derive_atlas(geometry.codes, request.stream.grid_bits(),
                                                static_cast<int>(set.sps_texture_cell_log2))));
  std::vector<std::optional<Error>> errors(wanted.size());
  parallel_ranges(wanted.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t g = begin; g < end; ++g) {
      if (const auto go_on = request.begin_unit(wanted[g]->payload.size()); !go_on) {
        errors[g] = go_on.error();
        continue;
      }
      const std::vector<std::size_t> planes = planes_of(request.groups[g]);
      std::vector<std::uint32_t> steps;
      for (const std::size_t j : planes) steps.push_back(request.steps[j]);
      const auto store = [&](std::size_t i, std::span<const std::int32_t> values) {
        store_plane(values, geometry.top.first, planes[i], request.planes(), components);
      };
      const auto done = in_unit(
          *wanted[g], decode_texture(wanted[g]->payload, atlas, set.texture_bits(), steps, store));
      if (!done) errors[g] = done.error();
    }
  });
  for (const auto& error : errors)
    if (error) return *error;
  return Done{};
}

}  // namespace slf
