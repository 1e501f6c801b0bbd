// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_plan.h"

#include <algorithm>
#include <cmath>

#include "tools/synth/noise.h"

namespace slf::synth {
namespace {

constexpr double kMeanWidth = 6.6;  // of a house

}  // namespace

Plan make_plan(int houses, std::uint32_t seed) {
  Plan plan;
  plan.streets = std::max(
      1, static_cast<int>(std::lround(std::sqrt(houses * kMeanWidth / (2 * kStreetPitch)))));
  const int rows = std::min(houses, 2 * plan.streets);
  const double longest = std::ceil(double(houses) / rows);
  plan.length = longest * kMeanWidth;
  int built = 0;
  for (int row = 0; row < rows; ++row) {
    const int count = (houses - built) / (rows - row);
    const double side = row % 2 == 0 ? 1 : -1;
    const double line = plan.street_y(row / 2) - side * kFrontAt;
    // Widths differ by up to a fifth; together they are those of so many mean houses.
    std::vector<double> ends{0};
    for (int i = 0; i < count; ++i)
      ends.push_back(ends.back() + 0.82 + 0.36 * unit(seed + 11, std::uint32_t(built + i)));
    const double scale = count * kMeanWidth / ends.back();
    for (int i = 0; i < count; ++i) {
      const auto number = static_cast<std::uint32_t>(built + i);
      const std::uint32_t own = mixed(seed, number);
      const double setback = 0.35 * unit(own, 1);
      plan.lots.push_back({scale * ends[std::size_t(i)] - plan.length / 2,
                           scale * ends[std::size_t(i) + 1] - plan.length / 2,
                           line - side * setback, side, own});
    }
    built += count;
  }
  return plan;
}

}  // namespace slf::synth
