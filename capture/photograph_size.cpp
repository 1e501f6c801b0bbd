// SPDX-License-Identifier: Apache-2.0
#include "capture/photograph_size.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "capture/image_cache.h"

namespace slf {
namespace {

constexpr int kMostReduction = 6;
constexpr int kLeastSide = 64;  // pixels of a reduced photograph
/// Pixels of a reduced photograph to a spacing, where it is nearest. A terrace of 1 million points,
/// pictures held out: -0.04 dB at -3 % bytes; with one pixel -0.4 dB at -11 %.
constexpr double kPixelsOfSpacing = 2;
constexpr std::size_t kNearestOf = 2000;  // points

/// Depth of the nearest point that the photograph shows; infinity where it shows none.
double nearest_depth(const Camera& camera, std::span<const std::array<float, 3>> positions) {
  double nearest = std::numeric_limits<double>::infinity();
  const std::size_t every = (positions.size() + kNearestOf - 1) / kNearestOf;
  for (std::size_t p = 0; p < positions.size(); p += every) {
    double depth = 0;
    const auto at = camera.project({positions[p][0], positions[p][1], positions[p][2]}, &depth);
    if (at && (*at)[0] >= 0 && (*at)[1] >= 0 && (*at)[0] < camera.width && (*at)[1] < camera.height)
      nearest = std::min(nearest, depth);
  }
  return nearest;
}

}  // namespace

int least_photograph(const Camera& camera, double nearest, double spacing) {
  if (!(nearest > 0)) return 0;
  const double pixels = spacing * std::max(camera.fx, camera.fy) / nearest;  // of a spacing
  int log2 = 0;
  while (log2 < kMostReduction && std::ldexp(kPixelsOfSpacing, log2 + 1) <= pixels &&
         std::min(camera.width, camera.height) >> (log2 + 1) >= kLeastSide)
    ++log2;
  return log2;
}

Capture photographs_alone(const Capture& capture) {
  Capture photographs;
  photographs.root = capture.root;
  photographs.origin = capture.origin;
  photographs.cameras = capture.cameras;
  photographs.image_files = capture.image_files;
  photographs.images = capture.images;
  photographs.mask_files = capture.mask_files;
  photographs.orientation = capture.orientation;
  photographs.reduction = capture.reduction;
  photographs.gains = capture.gains;
  photographs.cache = capture.cache;
  return photographs;
}

std::optional<Capture> smaller_photographs(const Capture& capture, std::span<const int> log2) {
  if (std::all_of(log2.begin(), log2.end(), [](int l) { return l == 0; })) return std::nullopt;
  Capture small = capture;
  small.cache.reset();  // of whole photographs
  small.reduction.resize(log2.size(), 0);
  for (std::size_t c = 0; c < log2.size(); ++c) {
    small.cameras[c] = reduced(small.cameras[c], log2[c]);
    small.reduction[c] += log2[c];
  }
  return small;
}

std::optional<Capture> photographs_for_points(const Capture& capture, std::span<const int> cameras,
                                              std::span<const std::array<float, 3>> positions,
                                              double spacing) {
  std::vector<int> log2(capture.cameras.size(), 0);
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[std::size_t(c)];
    log2[std::size_t(c)] = least_photograph(camera, nearest_depth(camera, positions), spacing);
  }
  return smaller_photographs(capture, log2);
}

std::optional<Capture> photographs_within(const Capture& capture, double megapixels) {
  if (megapixels == 0) return std::nullopt;
  std::vector<int> log2;
  for (const Camera& camera : capture.cameras) {
    const double pixels = 1e-6 * double(camera.width) * double(camera.height);
    log2.push_back(0);
    while (log2.back() < kMostReduction && pixels > std::ldexp(megapixels, 2 * log2.back()))
      ++log2.back();
  }
  return smaller_photographs(capture, log2);
}

}  // namespace slf
