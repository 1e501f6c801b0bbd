// SPDX-License-Identifier: Apache-2.0
// A float cloud onto the grid.
#include "capture/voxelise.h"

#include <algorithm>
#include <cmath>

#include "base/shortest.h"
#include "base/vec3.h"
#include "geometry/morton.h"

namespace slf {

namespace {

constexpr int kMaxBits = 21;

InputError invalid_cloud(const std::string& cause) {
  return {Errc::kInvalidInput, "point cloud: " + cause};
}

Result<Box, InputError> bounding_box(const PointCloud& cloud) {
  Box box;
  for (std::size_t i = 0; i < cloud.positions.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const double x = cloud.positions[i][k];
      if (!std::isfinite(x))
        return invalid_cloud("point " + std::to_string(i) + " has a coordinate that is not finite");
      box.min[k] = i == 0 ? x : std::min(box.min[k], x);
      box.max[k] = i == 0 ? x : std::max(box.max[k], x);
    }
  return box;
}

double cell_of(double x, double min, double step) { return std::floor((x - min) / step + 0.5); }

/// Spec 6.1 (informative there).
Result<Grid, InputError> grid_in(const Box& box, std::size_t points, int bits, double voxel_size) {
  Grid grid;
  grid.origin = box.min;
  const double extent = box.largest_extent();
  const InputError one_voxel = invalid_cloud("all points lie in one voxel");
  if (voxel_size > 0) {
    grid.step = voxel_size;
    const double last = cell_of(extent, 0, voxel_size);
    if (!(last < double(1 << kMaxBits)))
      return invalid_cloud("a voxel size of " + shortest(voxel_size) + " needs more than " +
                           std::to_string(kMaxBits) + " bits for an extent of " + shortest(extent));
    if (points > 1 && last == 0) return one_voxel;
    while (last >= double(1 << grid.bits)) ++grid.bits;
    return grid;
  }
  grid.bits = bits;
  grid.step = extent / double((1 << bits) - 1);
  if (grid.step > 0) return grid;
  if (points > 1) return one_voxel;
  grid.step = 1;  // one point: any will do
  return grid;
}

Result<Done, InputError> check_shown(const Grid& grid) {
  if (grid.fits_floats()) return Done{};
  return invalid_cloud(
      "it goes beyond 1e12 world units, or a voxel is below 1e-12: no picture "
      "could be drawn of it");
}

}  // namespace

Result<Grid, InputError> choose_grid(const Box& box, std::size_t points, int bits,
                                     double voxel_size) {
  SLF_TRY(Grid grid, grid_in(box, points, bits, voxel_size));
  SLF_CHECK(check_shown(grid));
  return grid;
}

namespace {

struct Cell {
  std::uint64_t code;  // Morton
  std::uint32_t point;
  bool operator<(const Cell& other) const {
    return code != other.code ? code < other.code : point < other.point;
  }
};

std::vector<Cell> sorted_cells(const PointCloud& cloud, const Grid& grid) {
  std::vector<Cell> cells(cloud.positions.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    cells[i] = {morton(voxel_at(cloud.positions[i], grid)), static_cast<std::uint32_t>(i)};
  std::sort(cells.begin(), cells.end());
  return cells;
}

// Mean over the points of one voxel, in the order of their indices.
template <class T>
Vec3 mean_over(const std::vector<std::array<T, 3>>& values, const std::vector<Cell>& cells,
               std::size_t begin, std::size_t end) {
  Vec3 sum{0, 0, 0};
  for (std::size_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 3; ++k) sum[k] += static_cast<double>(values[cells[i].point][k]);
  for (double& s : sum) s /= static_cast<double>(end - begin);
  return sum;
}

/// The mean at unit length; where two sides of a sheet share a voxel, the first point's.
std::array<float, 3> mean_normal(const std::vector<std::array<float, 3>>& normals,
                                 const std::vector<Cell>& cells, std::size_t begin,
                                 std::size_t end) {
  Vec3 normal = mean_over(normals, cells, begin, end);
  const double length = std::hypot(normal[0], normal[1], normal[2]);
  if (!(length > 1e-6)) return normals[cells[begin].point];
  for (double& n : normal) n /= length;
  return to_float(normal);
}

}  // namespace

Voxel voxel_at(const std::array<float, 3>& at, const Grid& grid) {
  const double last = double((1 << grid.bits) - 1);
  Voxel voxel{};
  for (std::size_t k = 0; k < 3; ++k)
    voxel[k] = static_cast<std::int32_t>(
        std::clamp(cell_of(double{at[k]}, grid.origin[k], grid.step), 0.0, last));
  return voxel;
}

Result<Grid, InputError> grid_of(const PointCloud& cloud, int bits, double voxel_size) {
  const auto argument = [](const std::string& cause) {
    return InputError{Errc::kInvalidArgument, cause};
  };
  const std::size_t count = cloud.positions.size();
  if (!(voxel_size >= 0) || !std::isfinite(voxel_size))
    return argument("voxel size: finite and not negative");
  if (voxel_size == 0 && (bits < 1 || bits > kMaxBits)) return argument("grid bits: 1 .. 21");
  if (count == 0) return invalid_cloud("no points");
  if (count > UINT32_MAX) return invalid_cloud("more than 2^32 - 1 points");
  if ((!cloud.normals.empty() && cloud.normals.size() != count) ||
      (!cloud.colours.empty() && cloud.colours.size() != count))
    return argument("point cloud: as many normals and colours as positions are needed");
  SLF_TRY(const Box box, bounding_box(cloud));
  return choose_grid(box, count, bits, voxel_size);
}

Result<VoxelCloud, InputError> voxelise(const PointCloud& cloud, int bits, double voxel_size) {
  SLF_TRY(const Grid grid, grid_of(cloud, bits, voxel_size));
  VoxelCloud voxels = voxelise_on(cloud, grid);
  voxels.grid = moved(grid, cloud.origin);
  SLF_CHECK(check_shown(voxels.grid));
  return voxels;
}

void for_each_voxel(const PointCloud& cloud, const Grid& grid,
                    const std::function<void(const OccupiedVoxel&)>& take) {
  const std::size_t count = cloud.positions.size();
  const auto cells = sorted_cells(cloud, grid);
  OccupiedVoxel voxel;
  for (std::size_t begin = 0, end = 0; begin < count; begin = end) {
    while (end < count && cells[end].code == cells[begin].code) ++end;
    voxel.code = cells[begin].code;
    if (!cloud.colours.empty())
      voxel.colour = to_float(mean_over(cloud.colours, cells, begin, end));
    if (!cloud.normals.empty()) voxel.normal = mean_normal(cloud.normals, cells, begin, end);
    take(voxel);
  }
}

VoxelCloud voxelise_on(const PointCloud& cloud, const Grid& grid) {
  VoxelCloud voxels;
  voxels.grid = grid;
  for_each_voxel(cloud, grid, [&](const OccupiedVoxel& voxel) {
    voxels.positions.push_back(from_morton(voxel.code));
    if (!cloud.normals.empty()) voxels.normals.push_back(voxel.normal);
    if (!cloud.colours.empty()) voxels.colours.push_back(voxel.colour);
  });
  voxels.merged = cloud.positions.size() - voxels.positions.size();
  return voxels;
}

}  // namespace slf
