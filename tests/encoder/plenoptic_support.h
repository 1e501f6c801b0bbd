// SPDX-License-Identifier: Apache-2.0
// A small plenoptic cloud: a sphere of voxels whose colours depend on the direction.
#pragma once

#include <cmath>
#include <numbers>
#include <random>

#include "geometry/morton.h"
#include "slf/plenoptic.h"
#include "tests/capture/capture_support.h"

namespace slf::test {

/// Seen by `views` cameras around it; smooth colours with noise of `noise` grey levels.
inline PlenopticCloud sphere_of_views(std::size_t views, int noise = 1, bool own_mean = true) {
  PlenopticCloud cloud;
  cloud.grid.bits = 6;
  cloud.views = views;
  cloud.own_colour = true;
  cloud.properties = {{"float", "x"},   {"float", "y"},     {"float", "z"},
                      {"uchar", "red"}, {"uchar", "green"}, {"uchar", "blue"}};
  for (std::size_t v = 0; v < views; ++v) {
    const double turn = 2 * std::numbers::pi * double(v) / double(views);
    cloud.view_positions.push_back(
        {30 + 200 * std::cos(turn), 30 + 200 * std::sin(turn), v % 2 == 0 ? 150.0 : -80.0});
    for (const char* name : {"first_", "second_", "third_"})
      cloud.properties.push_back({"uchar", name + std::to_string(v)});
  }
  for (std::uint64_t code = 0; code < 1u << 18; ++code) {
    const Voxel v = from_morton(code);
    if (std::abs(std::hypot(v[0] - 30, v[1] - 30, v[2] - 30) - 20) < 0.5)
      cloud.positions.push_back(v);
  }
  std::mt19937 random(7);
  for (const Voxel& v : cloud.positions) {
    std::vector<std::uint8_t> row(3 * views);
    std::array<unsigned, 3> sum{};
    for (std::size_t i = 0; i < row.size(); ++i) {
      const Vec3& eye = cloud.view_positions[i / 3];
      const double towards = ((eye[0] - v[0]) * (v[0] - 30) + (eye[1] - v[1]) * (v[1] - 30)) / 4000;
      const int value = static_cast<int>(90 + 30 * double(i % 3) + 2 * v[2] + 20 * towards) +
                        static_cast<int>(random() % static_cast<unsigned>(2 * noise + 1)) - noise;
      row[i] = static_cast<std::uint8_t>(std::clamp(value, 0, 255));
      sum[i % 3] += row[i];
    }
    const auto n = static_cast<unsigned>(views);
    for (std::size_t c = 0; c < 3; ++c)
      cloud.colours.push_back(
          static_cast<std::uint8_t>(own_mean ? (sum[c] + n / 2) / n : 255 - sum[c] / n));
    cloud.colours.insert(cloud.colours.end(), row.begin(), row.end());
  }
  return cloud;
}

}  // namespace slf::test
