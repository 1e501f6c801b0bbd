// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/region.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>

#include "base/vec3.h"
#include "geometry/morton.h"

namespace slf {
namespace {

using Cubes = std::vector<Voxel>;  // of cells, in cells

/// Cells that touch one of `cells` and are none of them, each with those that it touches.
std::map<std::size_t, Cubes> touching(const SceneCells& scene, std::span<const std::size_t> cells) {
  std::map<std::size_t, Cubes> found;
  const auto& codes = scene.layout.cells;
  const std::int32_t side = 1 << scene.layout.base_levels;
  for (const std::size_t cell : cells) {
    const Voxel cube = from_morton(codes[cell]);
    for (int d = 0; d < 27; ++d) {
      const Voxel there{cube[0] + d % 3 - 1, cube[1] + d / 3 % 3 - 1, cube[2] + d / 9 - 1};
      if (!std::all_of(there.begin(), there.end(), [&](auto x) { return x >= 0 && x < side; }))
        continue;
      const auto place = std::lower_bound(codes.begin(), codes.end(), morton(there));
      if (place == codes.end() || *place != morton(there)) continue;
      const auto index = static_cast<std::size_t>(place - codes.begin());
      if (!std::binary_search(cells.begin(), cells.end(), index)) found[index].push_back(cube);
    }
  }
  return found;
}

bool is_near(const Voxel& voxel, const Cubes& cubes, int cell_bits, std::int32_t around) {
  return std::any_of(cubes.begin(), cubes.end(), [&](const Voxel& cube) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int32_t low = cube[k] << cell_bits, high = low + (1 << cell_bits) - 1;
      if (voxel[k] < low - around || voxel[k] > high + around) return false;
    }
    return true;
  });
}

/// Adds the points of a cell: all, or those that are near to a cube.
Result<Done, InputError> add_cell(const SceneCells& scene, std::size_t cell, const Cubes* cubes,
                                  int around, Region& region) {
  SLF_TRY(const StoredPoints points,
          scene.store.read(scene.first[cell], scene.first[cell + 1] - scene.first[cell]));
  VoxelCloud& cloud = region.cloud;
  for (std::size_t p = 0; p < points.codes.size(); ++p) {
    const Voxel voxel = from_morton(points.codes[p]);
    if (cubes != nullptr && !is_near(voxel, *cubes, scene.cell_bits(), around)) continue;
    if (cubes == nullptr) region.own.push_back(static_cast<std::uint32_t>(cloud.positions.size()));
    cloud.positions.push_back(voxel);
    if (!points.normals.empty()) cloud.normals.push_back(points.normals[p]);
    if (!points.colours.empty()) cloud.colours.push_back(points.colours[p]);
  }
  return Done{};
}

}  // namespace

Result<SceneCells, InputError> SceneCells::open(const std::filesystem::path& directory,
                                                const std::string& digest, std::uint64_t points,
                                                const Grid& grid) {
  SceneCells cells;
  SLF_TRY(cells.store, PointStore::open(directory, digest, points));
  cells.grid = grid;
  return cells;
}

std::vector<std::uint64_t> Region::own_codes() const {
  std::vector<std::uint64_t> codes;
  codes.reserve(own.size());
  for (const std::uint32_t p : own) codes.push_back(morton(cloud.positions[p]));
  return codes;
}

std::vector<float> Region::own_rows(std::span<const float> of_all, std::size_t row) const {
  std::vector<float> rows;
  rows.reserve(own.size() * row);
  for (const std::uint32_t p : own) {
    const auto begin = of_all.begin() + static_cast<std::ptrdiff_t>(p * row);
    rows.insert(rows.end(), begin, begin + static_cast<std::ptrdiff_t>(row));
  }
  return rows;
}

Vec3 SceneCells::middle(std::size_t cell) const {
  const Voxel cube = from_morton(layout.cells[cell]);
  const double side = std::ldexp(1, cell_bits());
  Vec3 middle{};
  for (std::size_t k = 0; k < 3; ++k)
    middle[k] = grid.origin[k] + grid.step * ((cube[k] + 0.5) * side - 0.5);
  return middle;
}

double SceneCells::radius() const {
  return grid.step * std::ldexp(0.5 * std::sqrt(3.0), cell_bits());
}

Result<Region, InputError> read_region(const SceneCells& scene, std::span<const std::size_t> cells,
                                       int around) {
  std::map<std::size_t, Cubes> others;
  if (around > 0) others = touching(scene, cells);
  Region region;
  region.cloud.grid = scene.grid;
  auto other = others.begin();
  const auto add_others = [&](std::size_t before) -> Result<Done, InputError> {
    for (; other != others.end() && other->first < before; ++other)
      SLF_CHECK(add_cell(scene, other->first, &other->second, around, region));
    return Done{};
  };
  for (const std::size_t cell : cells) {
    SLF_CHECK(add_others(cell));
    SLF_CHECK(add_cell(scene, cell, nullptr, 0, region));
  }
  SLF_CHECK(add_others(scene.count()));
  return region;
}

std::vector<std::array<float, 3>> positions_of(const SceneCells& scene,
                                               std::span<const std::uint64_t> codes) {
  std::vector<std::array<float, 3>> positions;
  positions.reserve(codes.size());
  for (const std::uint64_t code : codes)
    positions.push_back(to_float(scene.grid.world(from_morton(code))));
  return positions;
}

}  // namespace slf
