// SPDX-License-Identifier: Apache-2.0
#include "tools/dump.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "slf/given_planes.h"
#include "slf/normals.h"
#include "slf/view_map.h"
#include "tools/describe.h"
#include "tools/npy.h"
#include "tools/output.h"
#include "tools/output_directory.h"
#include "tools/synth/shading.h"
#include "tools/text.h"

namespace slf::tools {
namespace {

/// On 0 .. 255: what a PLY viewer expects.
float display_of(float linear) {
  return static_cast<float>(255 * synth::srgb_from_linear(linear / 255.0));
}

void add_colours(const LightField& field, int threads, PointCloud& cloud) {
  const auto means = mean_colours(field, threads);
  const bool linear = field.header.transfer == Transfer::kLinear;
  cloud.colours.reserve(field.num_points());
  for (const auto& mean : means) {
    std::array<std::uint8_t, 3> rgb{};
    for (std::size_t c = 0; c < 3; ++c)
      rgb[c] = static_cast<std::uint8_t>((linear ? display_of(mean[c]) : mean[c]) + 0.5f);
    cloud.colours.push_back(rgb);
  }
}

/// Whether floats of world coordinates are less than a quarter of a voxel off.
bool floats_hold(const Grid& grid) {
  double farthest = 0;  // voxels
  for (const double x : grid.origin)
    farthest = std::max(farthest, std::abs(x) / grid.step + double(1 << grid.bits));
  return farthest < double(1 << 23);
}

/// Are coordinates finite floats, or from an origin that is a finite double? Two voxels differ.
bool fits_a_cloud(const Grid& grid) {
  constexpr double kMost = std::numeric_limits<float>::max(),
                   kLeast = std::numeric_limits<float>::min();
  const double extent = grid.step * double(1 << grid.bits);
  const double farthest = floats_hold(grid) ? kMost : std::numeric_limits<double>::max();
  return extent <= kMost && grid.step >= kLeast &&
         std::all_of(grid.origin.begin(), grid.origin.end(),
                     [&](double x) { return std::abs(x) <= farthest - extent; });
}

Outcome save_array(const std::string& directory, const char* name, const NpyFile& file) {
  return save(inside(directory, name),
              std::array{std::as_bytes(std::span(file.head)), file.elements});
}

/// Names of matrices: there are at most as many as groups.
constexpr std::size_t kMostMatrices = 16;

std::string matrix_name(std::size_t i) { return "matrix" + std::to_string(i) + ".npy"; }

/// Names of all files, the one that says that the others are whole last.
std::vector<std::string> dump_names() {
  std::vector<std::string> names = {"positions.npy", "components.npy", "planes.npy",
                                    "octahedral.npy"};
  for (std::size_t i = 0; i < kMostMatrices; ++i) names.push_back(matrix_name(i));
  names.push_back("light_field.json");
  return names;
}

std::size_t size_of(int count) { return static_cast<std::size_t>(count); }

Outcome save_points(const LightField& field, bool planes, const std::string& directory) {
  const std::size_t points = field.num_points();
  const std::span<const std::int32_t> positions(points == 0 ? nullptr : field.positions[0].data(),
                                                3 * points);
  SLF_CHECK(save_array(directory, "positions.npy", npy_file({points, 3}, positions)));
  SLF_CHECK(save_array(
      directory, "components.npy",
      npy_file({points, size_of(field.header.num_components()), 3}, std::span(field.components))));
  if (planes) {
    const std::vector<std::int32_t> given = given_planes(field);
    SLF_CHECK(
        save_array(directory, "planes.npy",
                   npy_file({points, size_of(field.header.num_functions), 3}, std::span(given))));
  }
  if (field.normals.bits == 0) return Done{};
  const auto& coded = field.normals.octahedral;
  const std::span<const std::uint16_t> normals(coded.empty() ? nullptr : coded[0].data(),
                                               2 * coded.size());
  return save_array(directory, "octahedral.npy", npy_file({coded.size(), 2}, normals));
}

/// Saves their matrices.
Result<nlohmann::ordered_json, Failure> save_transforms(const LightField& field,
                                                        const std::string& directory) {
  auto list = nlohmann::ordered_json::array();
  for (const PlaneTransform& t : field.header.transforms) {
    const std::string name = matrix_name(list.size());
    const std::size_t columns = t.components.size() * 3 / t.lanes;
    list.push_back({{"functions", t.functions},
                    {"components", t.components},
                    {"joint", t.lanes == 1},
                    {"colour", t.colour},
                    {"matrix", name}});
    SLF_CHECK(
        save_array(directory, name.c_str(),
                   npy_file({columns, t.rows()}, std::span(t.matrix.data(), columns * t.rows()))));
  }
  return list;
}

Outcome write_dump(const LightField& field, bool planes, const std::string& directory) {
  SLF_CHECK(save_points(field, planes, directory));
  nlohmann::ordered_json json = header_json(field.header);
  std::vector<int> coded(size_of(field.header.num_components()));
  for (std::size_t r = 0; r < coded.size(); ++r)
    coded[r] = field.header.coded.empty() ? static_cast<int>(r) : field.header.coded[r];
  json["component_function"] = coded;
  SLF_TRY(json["transforms"], save_transforms(field, directory));
  json["points"] = field.num_points();
  json["normal_bits"] = field.normals.bits;
  json["partial"] = field.partial;
  return save(inside(directory, "light_field.json"), to_text(json));
}

}  // namespace

PointCloud mean_cloud(const LightField& field, int threads) {
  PointCloud cloud;
  cloud.positions.reserve(field.num_points());
  Grid grid = field.header.grid;
  if (!floats_hold(grid)) cloud.origin = std::exchange(grid.origin, Vec3{0, 0, 0});
  for (const Voxel& v : field.positions) {
    const Vec3 w = grid.world(v);
    cloud.positions.push_back(
        {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])});
  }
  if (field.normals.bits > 0)
    for (const auto& coded : field.normals.octahedral) {
      const Vec3 n = decode_normal(coded, field.normals.bits);
      cloud.normals.push_back(
          {static_cast<float>(n[0]), static_cast<float>(n[1]), static_cast<float>(n[2])});
    }
  if (field.header.has_basis && field.header.num_functions > 0) add_colours(field, threads, cloud);
  return cloud;
}

Outcome require_cloud_grid(const LightField& field, const std::string& file) {
  if (fits_a_cloud(field.header.grid)) return Done{};
  return Failure{kInputInvalid, input_name(file) +
                                    ": its points lie beyond what a PLY can hold (slf decode "
                                    "--dump writes them)"};
}

Outcome dump(const LightField& field, bool planes, const std::string& directory) {
  return save_directory(directory, dump_names(),
                        [&](const std::string& made) { return write_dump(field, planes, made); });
}

}  // namespace slf::tools
