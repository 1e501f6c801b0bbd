// SPDX-License-Identifier: Apache-2.0
#include "tools/rd/igc/camera_walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace slf {
namespace {

/// Centre and viewing direction.
std::array<double, 6> view_of(const Camera& camera) {
  const Vec3 centre = camera.centre();
  const auto& forward = camera.rotation[2];
  return {centre[0], centre[1], centre[2], forward[0], forward[1], forward[2]};
}

/// Root mean square distance from the mean centre; 1 where all centres coincide.
double spread(const std::vector<std::array<double, 6>>& views) {
  const auto count = static_cast<double>(views.size());
  double sum = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double mean = 0;
    for (const auto& view : views) mean += view[axis] / count;
    for (const auto& view : views) sum += (view[axis] - mean) * (view[axis] - mean) / count;
  }
  return sum > 0 ? std::sqrt(sum) : 1;
}

std::vector<int> nearest_neighbours(const ViewDistance& distance, std::size_t count) {
  std::vector<int> walk(count);
  std::iota(walk.begin(), walk.end(), 0);
  for (std::size_t i = 1; i + 1 < count; ++i) {
    std::size_t best = i;
    for (std::size_t j = i + 1; j < count; ++j) {
      const double gain = distance(walk[i - 1], walk[best]) - distance(walk[i - 1], walk[j]);
      if (gain > 0 || (gain == 0 && walk[j] < walk[best])) best = j;
    }
    std::swap(walk[i], walk[best]);
  }
  return walk;
}

/// One round of 2-opt over a walk with a fixed beginning and a free end. @return whether shorter
bool shorten(const ViewDistance& distance, std::vector<int>& walk) {
  constexpr double kLeastGain = 1e-9;  // so that rounding cannot make it go round for ever
  bool shorter = false;
  for (std::size_t i = 1; i + 1 < walk.size(); ++i)
    for (std::size_t j = i + 1; j < walk.size(); ++j) {
      // Reverses walk[i .. j].
      double gain = distance(walk[i - 1], walk[i]) - distance(walk[i - 1], walk[j]);
      if (j + 1 < walk.size())
        gain += distance(walk[j], walk[j + 1]) - distance(walk[i], walk[j + 1]);
      if (gain <= kLeastGain) continue;
      std::reverse(walk.begin() + static_cast<std::ptrdiff_t>(i),
                   walk.begin() + static_cast<std::ptrdiff_t>(j + 1));
      shorter = true;
    }
  return shorter;
}

}  // namespace

ViewDistance::ViewDistance(const Capture& capture, std::span<const int> cameras) {
  for (const int camera : cameras)
    views_.push_back(view_of(capture.cameras[static_cast<std::size_t>(camera)]));
  const double unit = spread(views_);
  for (auto& view : views_)
    for (std::size_t axis = 0; axis < 3; ++axis) view[axis] /= unit;
}

double ViewDistance::operator()(int a, int b) const {
  double sum = 0;
  for (std::size_t i = 0; i < 6; ++i) {
    const double d =
        views_[static_cast<std::size_t>(a)][i] - views_[static_cast<std::size_t>(b)][i];
    sum += d * d;
  }
  return std::sqrt(sum);
}

double walk_length(const ViewDistance& distance, std::span<const int> walk) {
  double length = 0;
  for (std::size_t i = 1; i < walk.size(); ++i) length += distance(walk[i - 1], walk[i]);
  return length;
}

std::vector<int> camera_walk(const Capture& capture, std::span<const int> cameras) {
  const ViewDistance distance(capture, cameras);
  std::vector<int> given(cameras.size());
  std::iota(given.begin(), given.end(), 0);
  std::vector<int> walk = nearest_neighbours(distance, cameras.size());
  if (walk_length(distance, given) < walk_length(distance, walk)) walk = given;
  while (shorten(distance, walk)) {
  }
  return walk;
}

}  // namespace slf
