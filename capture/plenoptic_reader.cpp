// SPDX-License-Identifier: Apache-2.0
// A PLY with the colours of N views to a cloud on a grid.
#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>
#include <optional>

#include "base/release.h"
#include "capture/input_file.h"
#include "capture/plenoptic_columns.h"
#include "capture/plenoptic_views.h"
#include "capture/ply_body.h"
#include "geometry/morton.h"
#include "slf/plenoptic.h"

namespace slf {

namespace {

constexpr std::size_t kMostHead = std::size_t{1} << 20;
constexpr double kMostCoordinate = (1 << 21) - 1;

/// Rows of a file, in its order.
struct PlenopticRows {
  std::vector<Vec3> positions;
  std::vector<std::uint8_t> colours;  // [rows][bytes]
  std::size_t left_out = 0;
  bool whole = true;  // all coordinates are whole numbers
};

InputError refused_cloud(const std::string& name, const std::string& cause) {
  return {Errc::kInvalidInput, name + ": " + cause};
}

Result<PlenopticRows, InputError> read_rows(const std::string& name, const PlyElement& vertex,
                                            const PlenopticColumns& columns, PlyBody& body) {
  PlenopticRows rows;
  const auto count = static_cast<std::size_t>(vertex.count);  // bounded by the file's size
  const std::size_t bytes = 3 * (columns.views + (columns.own_colour ? 1 : 0));
  rows.positions.reserve(count);
  rows.colours.reserve(count * bytes);
  std::vector<std::uint8_t> colours(bytes);
  for (std::size_t i = 0; i < count; ++i) {
    Vec3 position{};
    for (std::size_t p = 0; p < vertex.properties.size(); ++p) {
      const PlyProperty& property = vertex.properties[p];
      double value = 0;
      if (!(property.is_list ? body.skip_list(property) : body.value(property.type, value)))
        return refused_cloud(name, "vertex " + std::to_string(i) + ", property " + property.name +
                                       " is missing or damaged");
      if (!columns.place[p]) continue;
      if (*columns.place[p] < 3) {
        position[*columns.place[p]] = value;
        continue;
      }
      if (!(value >= 0 && value <= 255) || value != std::floor(value))  // of text
        return refused_cloud(name, "vertex " + std::to_string(i) + ", property " + property.name +
                                       " is no whole number of 0 to 255");
      colours[*columns.place[p] - 3] = static_cast<std::uint8_t>(value);
    }
    if (!std::all_of(position.begin(), position.end(), [](double x) { return std::isfinite(x); })) {
      ++rows.left_out;
      continue;
    }
    for (const double x : position) rows.whole = rows.whole && x == std::floor(x);
    rows.positions.push_back(position);
    rows.colours.insert(rows.colours.end(), colours.begin(), colours.end());
  }
  return rows;
}

/// The grid of the points. Whole coordinates keep theirs.
Result<Grid, InputError> grid_of(const std::string& name, const PlenopticRows& rows,
                                 const PlenopticColumns& columns, const PlenopticOptions& options) {
  Vec3 low = rows.positions[0], high = low;
  for (const Vec3& p : rows.positions)
    for (std::size_t k = 0; k < 3; ++k) {
      low[k] = std::min(low[k], p[k]);
      high[k] = std::max(high[k], p[k]);
    }
  const double extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  Grid grid;
  if (rows.whole && extent <= kMostCoordinate) {
    const bool moved = std::min({low[0], low[1], low[2]}) < 0 ||
                       std::max({high[0], high[1], high[2]}) > kMostCoordinate;
    if (moved) grid.origin = low;
    const double most = moved ? extent : std::max({high[0], high[1], high[2]});
    grid.bits = std::max(1, static_cast<int>(std::bit_width(static_cast<std::uint32_t>(most))));
    return grid;
  }
  const int grid_bits = options.one_of_several ? 0 : options.grid_bits;
  if (grid_bits == 0)
    return refused_cloud(
        name, "is taken for a plenoptic cloud of " + columns.taken +
                  ". Its coordinates are not whole numbers that fit 21 bits" +
                  (options.one_of_several ? ", which is the one grid that frames can have"
                                          : ": --grid-bits 12, or as many as it is to have, puts "
                                            "them on a grid") +
                  (columns.own_colour ? "; --as colour takes red, green, blue alone" : ""));
  if (!(extent > 0)) return refused_cloud(name, "all points are in one place");
  grid.origin = low;
  grid.bits = grid_bits;
  grid.step = extent / ((1 << grid_bits) - 1);
  return grid;
}

/// Morton order; points of one place become one, whose bytes are means.
void sort_rows(PlenopticRows rows, PlenopticCloud& cloud) {
  const std::size_t count = rows.positions.size(), bytes = 3 * cloud.num_colours();
  std::vector<std::uint64_t> codes(count);
  for (std::size_t i = 0; i < count; ++i) {
    Voxel v{};
    for (std::size_t k = 0; k < 3; ++k)
      v[k] = static_cast<std::int32_t>(
          std::floor((rows.positions[i][k] - cloud.grid.origin[k]) / cloud.grid.step + 0.5));
    codes[i] = morton(v);
  }
  release(rows.positions);
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
  });
  cloud.positions.reserve(count);
  cloud.colours.reserve(count * bytes);
  std::vector<std::uint64_t> sum(bytes);
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    std::fill(sum.begin(), sum.end(), 0);
    for (; end < count && codes[order[end]] == codes[order[begin]]; ++end)
      for (std::size_t j = 0; j < bytes; ++j) sum[j] += rows.colours[order[end] * bytes + j];
    cloud.positions.push_back(from_morton(codes[order[begin]]));
    for (std::size_t j = 0; j < bytes; ++j)
      cloud.colours.push_back(
          static_cast<std::uint8_t>((sum[j] + (end - begin) / 2) / (end - begin)));
  }
  cloud.merged = count - cloud.positions.size();
}

Result<Done, InputError> find_views(const std::string& name, const PlyHeader& header,
                                    const std::filesystem::path& file, PlenopticCloud& cloud,
                                    std::vector<std::string>& warnings) {
  if (cloud.views == 1)
    warnings.push_back(name +
                       ": one view: its colours tell no directions; --as colour codes red, "
                       "green, blue as a cloud of one colour");
  if (!file.empty()) {
    SLF_TRY(cloud.view_positions, read_views(file));
    if (cloud.view_positions.size() == cloud.views) return Done{};
    return refused_cloud(file.string(), std::to_string(cloud.view_positions.size()) +
                                            " positions of views; " + name + " has " +
                                            std::to_string(cloud.views) +
                                            " views: give one for each, in the order of the "
                                            "properties");
  }
  cloud.view_positions = views_of_comments(header.comments);
  if (cloud.view_positions.empty() || cloud.view_positions.size() == cloud.views) return Done{};
  warnings.push_back(name + ": comment lines have " + std::to_string(cloud.view_positions.size()) +
                     " positions of views, of which there are " + std::to_string(cloud.views) +
                     ": not used (--views FILE)");
  cloud.view_positions.clear();
  return Done{};
}

void warn_of_rows(const std::string& name, const PlenopticColumns& columns,
                  const PlenopticRows& rows, std::vector<std::string>& warnings) {
  if (!columns.left_out.empty())
    warnings.push_back(name + ": properties left out: " + columns.left_out);
  if (rows.left_out > 0)
    warnings.push_back(name + ": " + std::to_string(rows.left_out) +
                       " points are not finite: left out");
}

struct OpenedPly {
  InputFile file;
  std::vector<std::uint8_t> head;
  PlyHeader header;
};

Result<OpenedPly, InputError> open_ply(const std::filesystem::path& file) {
  SLF_TRY(InputFile input, InputFile::open(file));
  std::vector<std::uint8_t> head(kMostHead);
  SLF_TRY(const std::size_t count, input.read(head));
  head.resize(count);
  SLF_TRY(PlyHeader header, parse_ply_header(file.string(), head, input.size()));
  return OpenedPly{std::move(input), std::move(head), std::move(header)};
}

}  // namespace

std::size_t count_plenoptic_views(const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored)) return 0;
  const auto opened = open_ply(file);
  if (!opened) return 0;
  for (const PlyElement& element : opened->header.elements) {
    if (element.name != "vertex") continue;
    const auto columns = plenoptic_columns(element, PlenopticNames::kNoneOfScans);
    return columns ? columns->views : kMostViews + 1;  // which read_plenoptic refuses in words
  }
  return 0;
}

Result<PlenopticCloud, InputError> read_plenoptic(const std::filesystem::path& file,
                                                  const PlenopticOptions& options,
                                                  std::vector<std::string>* warnings) {
  const std::string name = file.string();
  SLF_TRY(OpenedPly ply, open_ply(file));
  PlyBody body(ply.file, std::move(ply.head), ply.header.body, ply.header.format);
  std::vector<std::string> said;
  for (const PlyElement& element : ply.header.elements) {
    if (element.name != "vertex") {
      if (!body.skip_element(element))
        return refused_cloud(name, "PLY element '" + element.name + "' is cut off or damaged");
      continue;
    }
    auto columns = plenoptic_columns(element, PlenopticNames::kNoneOfScans);
    if (!columns) return refused_cloud(name, columns.error().message);
    if (columns->views == 0)
      return refused_cloud(name, "no views: its vertices have fewer than two colours of 8 bits");
    PlenopticCloud cloud;
    cloud.views = columns->views;
    cloud.own_colour = columns->own_colour;
    cloud.taken = columns->taken;
    for (std::size_t p = 0; p < element.properties.size(); ++p)
      if (columns->place[p])
        cloud.properties.push_back(
            {name_of(element.properties[p].type), element.properties[p].name});
    SLF_CHECK(find_views(name, ply.header, options.views, cloud, said));
    SLF_TRY(PlenopticRows rows, read_rows(name, element, *columns, body));
    if (rows.positions.empty()) return refused_cloud(name, "no points");
    SLF_TRY(cloud.grid, grid_of(name, rows, *columns, options));
    if (!cloud.grid.fits_floats())
      return refused_cloud(name,
                           "its coordinates go beyond 1e12, or are all within 1e-12 of each "
                           "other: no picture could be drawn of it");
    warn_of_rows(name, *columns, rows, said);
    sort_rows(std::move(rows), cloud);
    if (cloud.merged > 0)
      said.push_back(name + ": " + std::to_string(cloud.merged) +
                     " points share a voxel with another: their colours are averaged");
    if (warnings != nullptr) warnings->insert(warnings->end(), said.begin(), said.end());
    return cloud;
  }
  return refused_cloud(name, "PLY without vertices");
}

}  // namespace slf
