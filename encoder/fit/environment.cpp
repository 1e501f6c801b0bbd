// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/environment.h"

#include <algorithm>
#include <cmath>

#include "encoder/fit/lane_products.h"
#include "lightfield/harmonics.h"
#include "slf/parallel.h"

namespace slf {
namespace {

/// Cells along the edge of a face: a harmonic of degree 16 has 31 of them to a wave at least.
constexpr std::size_t kSide = 160, kNodes = kSide + 1;

double node(std::size_t i) { return 2.0 * static_cast<double>(i) / kSide - 1; }

/// Faces towards x, -x, y, -y, z, -z; u and v, within -1 .. 1, along the two axes that follow.
Vec3 on_face(std::size_t face, double u, double v) {
  const std::size_t axis = face / 2;
  const double length = std::sqrt(1 + u * u + v * v);
  Vec3 place{};
  place[axis] = (face % 2 == 0 ? 1 : -1) / length;
  place[(axis + 1) % 3] = u / length;
  place[(axis + 2) % 3] = v / length;
  return place;
}

}  // namespace

ObjectBox::ObjectBox(std::span<const Voxel> positions) {
  double longest = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    auto low = positions.front()[a], high = low;
    for (const Voxel& v : positions) {
      low = std::min(low, v[a]);
      high = std::max(high, v[a]);
    }
    centre_[a] = 0.5 * (static_cast<double>(low) + static_cast<double>(high));
    longest = std::max(longest, static_cast<double>(high) - static_cast<double>(low));
  }
  half_ = longest > 0 ? longest / 2 : 1;
}

Vec3 ObjectBox::operator()(const Voxel& voxel) const {
  Vec3 at{};
  for (std::size_t a = 0; a < 3; ++a) at[a] = (static_cast<double>(voxel[a]) - centre_[a]) / half_;
  return at;
}

Vec3 place_on_sphere(const Vec3& position, const Vec3& direction, double radius) {
  double along = 0, squared = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    along += position[a] * direction[a];
    squared += position[a] * position[a];
  }
  const double distance =
      -along + std::sqrt(std::max(0.0, along * along + radius * radius - squared));
  Vec3 place{};
  for (std::size_t a = 0; a < 3; ++a) place[a] = (position[a] + distance * direction[a]) / radius;
  return place;
}

Environment::Environment(double radius, int degree, std::span<const float> light, int threads)
    : radius_(radius), table_(6 * kNodes * kNodes) {
  const Harmonics harmonics(degree);
  const std::size_t functions = light.size() / 3, stride = padded(kNodes);
  std::vector<float> channels(4 * functions, 0.0f);
  for (std::size_t k = 1; k < functions; ++k)
    for (std::size_t c = 0; c < 3; ++c) channels[4 * k + c] = light[3 * k + c];
  parallel_ranges(6 * kNodes, 1, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<float> values(functions * stride), sums;
    for (std::size_t row = begin; row < end; ++row) {
      std::vector<Vec3> places;
      for (std::size_t i = 0; i < kNodes; ++i)
        places.push_back(on_face(row / kNodes, node(i), node(row % kNodes)));
      harmonics.evaluate_columns(places, values.data(), stride);
      sums.assign(4 * stride, 0.0f);
      add_products(functions, channels.data(), 4, 4, values.data(), stride, stride, sums.data());
      for (std::size_t i = 0; i < kNodes; ++i)
        for (std::size_t c = 0; c < 3; ++c) table_[row * kNodes + i][c] = sums[c * stride + i];
    }
  });
}

std::array<float, 3> Environment::operator()(const Vec3& position, const Vec3& reflected) const {
  const Vec3 place = place_on_sphere(position, reflected, radius_);
  const Vec3 size = {std::abs(place[0]), std::abs(place[1]), std::abs(place[2])};
  std::size_t axis = size[1] > size[0] ? 1 : 0;
  if (size[2] > size[axis]) axis = 2;
  const std::size_t face = 2 * axis + (place[axis] < 0 ? 1 : 0);
  const double half = kSide / 2.0, scale = half / size[axis];
  const double column = place[(axis + 1) % 3] * scale + half;
  const double row = place[(axis + 2) % 3] * scale + half;
  const auto y = std::min(static_cast<std::size_t>(row), kSide - 1);
  const auto x = std::min(static_cast<std::size_t>(column), kSide - 1);
  const auto wy = static_cast<float>(row - static_cast<double>(y)),
             wx = static_cast<float>(column - static_cast<double>(x));
  const auto* above = &table_[(face * kNodes + y) * kNodes + x];
  const auto* below = above + kNodes;
  std::array<float, 3> light{};
  for (std::size_t c = 0; c < 3; ++c)
    light[c] = (1 - wy) * ((1 - wx) * above[0][c] + wx * above[1][c]) +
               wy * ((1 - wx) * below[0][c] + wx * below[1][c]);
  return light;
}

}  // namespace slf
