// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/regions.h"

#include <array>
#include <cmath>
#include <map>

namespace slf {
namespace {

using Cube = std::array<std::int32_t, 3>;

struct Sums {
  double before = 0, views_before = 0, after = 0, views_after = 0;
};

Cube cube_of(const Float3& at, double side) {
  Cube cube{};
  for (std::size_t a = 0; a < 3; ++a)
    cube[a] = static_cast<std::int32_t>(std::floor(double(at[a]) / side));
  return cube;
}

void append(SurfacePoints& to, const SurfacePoints& from, std::size_t p) {
  to.positions.push_back(from.positions[p]);
  to.normals.push_back(from.normals[p]);
  to.source.push_back(from.source[p]);
}

Sums sum_around(const std::map<Cube, Sums>& cubes, const Cube& centre) {
  Sums sum;
  for (std::int32_t z = -1; z <= 1; ++z)
    for (std::int32_t y = -1; y <= 1; ++y)
      for (std::int32_t x = -1; x <= 1; ++x) {
        const auto found = cubes.find({centre[0] + x, centre[1] + y, centre[2] + z});
        if (found == cubes.end()) continue;
        // The cube itself counts 8, one that shares a corner 1.
        const double weight = (x == 0 ? 2 : 1) * (y == 0 ? 2 : 1) * (z == 0 ? 2 : 1);
        sum.before += weight * found->second.before;
        sum.views_before += weight * found->second.views_before;
        sum.after += weight * found->second.after;
        sum.views_after += weight * found->second.views_after;
      }
  return sum;
}

}  // namespace

std::vector<std::uint8_t> worse_after(const SurfacePoints& before,
                                      const HeldOutErrors& errors_before,
                                      const SurfacePoints& after, const HeldOutErrors& errors_after,
                                      const HeldOutErrors& uncovered, double side) {
  std::map<Cube, Sums> cubes;
  for (std::size_t p = 0; p < before.size(); ++p) {
    Sums& sums = cubes[cube_of(before.positions[p], side)];
    sums.before += double(errors_before.squares[p]);
    sums.views_before += double(errors_before.views[p]);
    sums.after += double(uncovered.squares[p]);
    sums.views_after += double(uncovered.views[p]);
  }
  for (std::size_t p = 0; p < after.size(); ++p) {
    Sums& sums = cubes[cube_of(before.positions[after.source[p]], side)];
    sums.after += double(errors_after.squares[p]);
    sums.views_after += double(errors_after.views[p]);
  }
  std::map<Cube, bool> worse;
  for (const auto& [cube, own] : cubes) {
    const Sums sum = sum_around(cubes, cube);
    worse[cube] =
        sum.views_before > 0 && sum.after * sum.views_before > sum.before * sum.views_after;
  }
  std::vector<std::uint8_t> marked(before.size());
  for (std::size_t p = 0; p < before.size(); ++p)
    marked[p] = worse[cube_of(before.positions[p], side)];
  return marked;
}

SurfacePoints with_kept(const SurfacePoints& before, const SurfacePoints& after,
                        const std::vector<std::uint8_t>& marked) {
  SurfacePoints both;
  for (std::size_t p = 0; p < after.size(); ++p)
    if (marked[after.source[p]] == 0) append(both, after, p);
  for (std::size_t p = 0; p < before.size(); ++p)
    if (marked[p] != 0) append(both, before, p);
  return both;
}

SurfacePoints without_unsupported(const SurfacePoints& before, const SurfacePoints& after,
                                  const std::vector<std::uint8_t>& seen, double move) {
  SurfacePoints supported;
  for (std::size_t p = 0; p < after.size(); ++p) {
    const Float3 apart = minus(after.positions[p], before.positions[after.source[p]]);
    if (seen[p] != 0 || double(dot(apart, apart)) <= move * move) append(supported, after, p);
  }
  return supported;
}

}  // namespace slf
