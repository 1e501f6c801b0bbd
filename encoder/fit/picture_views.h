// SPDX-License-Identifier: Apache-2.0
// Photographs as a picture fit sees them: which pixels count, and which points they are made of.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/fit/direction_kernel.h"
#include "encoder/fit/observe_points.h"
#include "lightfield/render/surfel_cloud.h"
#include "slf/capture.h"
#include "slf/error.h"
#include "slf/fit.h"

namespace slf {

/// One photograph. Contributions are most of what a picture fit holds, ten of 6 bytes a pixel.
struct PictureView {
  std::vector<std::uint32_t> points;  ///< that it shows, ascending
  std::vector<std::uint32_t> ray;     ///< [points] the place of each among all rays
  std::vector<std::uint32_t> first;   ///< [pixels + 1] contributions of each pixel that counts
  /// [contributions] index into points: its lower 16 bits, and those above, none where all are 0.
  std::vector<std::uint16_t> local_low, local_high;
  std::vector<float> weight;                         ///< [contributions] of sum 1 over a pixel
  std::vector<std::array<std::uint8_t, 3>> samples;  ///< [pixels] of the photograph
  std::array<std::array<float, 256>, 3> level{};     ///< of a sample, 0 .. 255 times the gain
  std::vector<float> trust;                          ///< [pixels] 0 .. 1

  std::size_t pixels() const { return samples.size(); }

  Colour4 photograph(std::size_t pixel) const {
    const auto& sample = samples[pixel];
    return {level[0][sample[0]], level[1][sample[1]], level[2][sample[2]], 0};
  }

  std::uint32_t local(std::size_t j) const {
    return local_high.empty() ? local_low[j] : std::uint32_t{local_high[j]} << 16 | local_low[j];
  }
  /// @param local  [contributions] below points.size()
  void set_local(std::span<const std::uint32_t> local);
};

/// The lines of sight between points and the cameras whose pictures show them, by point.
struct Rays {
  std::vector<std::uint64_t> first;  ///< [P + 1]
  std::vector<std::uint32_t> view;   ///< [rays]

  std::size_t size() const { return view.size(); }
};

struct PictureViews {
  std::vector<PictureView> views;  ///< [cameras]
  Rays rays;
};

/// Reads the photographs.
/// @param gains  [cameras] of R, G, B; where one is not 1, what is at the upper end does not count.
/// Or
///               empty: 1. A pixel counts if discs cover it and its alpha shows the object. Where
/// pixels or rays are too many for the memory of a fit (3 GiB; of a part of a scene, with
/// hidden_by, 0.75 GiB), photographs are halved, twice at most and not of a part; and if that does
/// not do, every n-th camera shows something, the others nothing.
/// @param hidden_by  of what is not in the cloud: a pixel where it is in front does not count; may
///                   be empty
/// @errors those of load_image and of hidden_by
/// The same for any thread count.
Result<PictureViews, InputError> picture_views(const Capture& capture, std::span<const int> cameras,
                                               std::span<const std::array<float, 3>> gains,
                                               const SurfelCloud& cloud, Transfer transfer,
                                               const DepthOfCamera& hidden_by, int threads,
                                               const Progress& progress);

/// What of some photographs shows some of the points and nothing else; other views are empty.
/// @param points  ascending indices; those of the result are into these
/// @param count   how many points there are
/// @param wanted  [views]
PictureViews views_of_points(const PictureViews& of, std::span<const std::uint32_t> points,
                             std::size_t count, const std::vector<bool>& wanted);

}  // namespace slf
