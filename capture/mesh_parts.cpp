// SPDX-License-Identifier: Apache-2.0
#include "capture/mesh_parts.h"

#include <algorithm>
#include <cmath>

#include "base/shortest.h"
#include "capture/mesh_sampling.h"
#include "capture/mesh_triangles.h"
#include "geometry/morton.h"

namespace slf {
namespace {

constexpr double kMostPairs = 1 << 24, kMostPointsOfMesh = 1 << 30;
constexpr double kBorder = 2;  // voxels beyond a triangle where points of it may come to lie

/// A triangle, and a cube that it may have points in.
struct Pair {
  std::uint64_t cube;  // Morton
  std::uint32_t triangle;
  bool operator<(const Pair& other) const {
    return cube != other.cube ? cube < other.cube : triangle < other.triangle;
  }
};

struct Cubes {
  Voxel low, high;

  double count() const {
    double cubes = 1;
    for (std::size_t k = 0; k < 3; ++k) cubes *= high[k] - low[k] + 1;
    return cubes;
  }
};

Cubes cubes_about(const Corners& corners, const Grid& grid) {
  const double last = std::ldexp(1, grid.bits) - 1;
  Cubes about{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax({corners[0][k], corners[1][k], corners[2][k]});
    const auto cube_of = [&](double x, double border) {
      const double voxel = std::clamp((x - grid.origin[k]) / grid.step + border, 0.0, last);
      return static_cast<std::int32_t>(voxel) >> kCubeLog2;
    };
    about.low[k] = cube_of(low, -kBorder);
    about.high[k] = cube_of(high, kBorder);
  }
  return about;
}

Result<std::vector<Pair>, InputError> pairs_of(const Mesh& mesh, const Grid& grid) {
  double count = 0;
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f)
    count += cubes_about(corners_of(mesh, f), grid).count();
  if (count > kMostPairs || sampled_area(mesh) / (grid.step * grid.step) > kMostPointsOfMesh)
    return InputError{Errc::kInvalidInput, "mesh: a voxel size of " + shortest(grid.step) +
                                               " is too small for its faces"};
  std::vector<Pair> pairs;
  pairs.reserve(static_cast<std::size_t>(count));
  for (std::size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Cubes about = cubes_about(corners_of(mesh, f), grid);
    for (std::int32_t z = about.low[2]; z <= about.high[2]; ++z)
      for (std::int32_t y = about.low[1]; y <= about.high[1]; ++y)
        for (std::int32_t x = about.low[0]; x <= about.high[0]; ++x)
          pairs.push_back({morton({x, y, z}), static_cast<std::uint32_t>(f)});
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

Result<Done, InputError> for_each_mesh_voxel(
    const Mesh& mesh, const Grid& grid, const std::function<void(const OccupiedVoxel&)>& take) {
  SLF_TRY(const std::vector<Pair> pairs, pairs_of(mesh, grid));
  std::vector<std::uint32_t> triangles;
  for (std::size_t begin = 0, end = 0; begin < pairs.size(); begin = end) {
    triangles.clear();
    for (; end < pairs.size() && pairs[end].cube == pairs[begin].cube; ++end)
      triangles.push_back(pairs[end].triangle);
    MeshWindow window;
    const Voxel cube = from_morton(pairs[begin].cube);
    for (std::size_t k = 0; k < 3; ++k) {
      window.low[k] = cube[k] << kCubeLog2;
      window.high[k] = window.low[k] + (1 << kCubeLog2) - 1;
    }
    window.triangles = triangles;
    SLF_TRY(const PointCloud points, sample_mesh_in(mesh, grid, window));
    for_each_voxel(points, grid, take);
  }
  return Done{};
}

}  // namespace slf
