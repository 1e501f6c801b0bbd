// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/carve.h"

#include <cmath>
#include <limits>

#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kSteps = 24;    // tries from the point to the farthest place
constexpr int kHalvings = 4;  // of a step: where the hull begins

/// How far inwards the hull begins; not finite: nowhere.
float way_inside(const std::vector<Outline>& outlines, const Float3& position, const Float3& normal,
                 double half_side, double farthest) {
  const auto inside = [&](double way) {
    const Float3 at = along(position, float(-way), normal);
    return in_hull(outlines, {at[0], at[1], at[2]}, half_side);
  };
  if (inside(0)) return 0;
  const double step = farthest / kSteps;
  int steps = 1;
  while (steps <= kSteps && !inside(steps * step)) ++steps;
  if (steps > kSteps) return std::numeric_limits<float>::infinity();
  double out = (steps - 1) * step, in = steps * step;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (out + in) / 2;
    (inside(middle) ? in : out) = middle;
  }
  return float(in);
}

}  // namespace

void carve(SurfacePoints& surface, const std::vector<Outline>& outlines, double half_side,
           double farthest, int threads) {
  if (outlines.empty()) return;
  std::vector<float> ways(surface.size());
  parallel_ranges(surface.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      ways[p] = way_inside(outlines, surface.positions[p], surface.normals[p], half_side, farthest);
  });
  std::size_t kept = 0;
  for (std::size_t p = 0; p < ways.size(); ++p) {
    if (!std::isfinite(ways[p])) continue;
    surface.positions[kept] = along(surface.positions[p], -ways[p], surface.normals[p]);
    surface.normals[kept] = surface.normals[p];
    surface.source[kept] = surface.source[p];
    ++kept;
  }
  surface.positions.resize(kept);
  surface.normals.resize(kept);
  surface.source.resize(kept);
}

}  // namespace slf
