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

/// One photograph.
struct PictureView {
  std::vector<std::uint32_t> points;  ///< that it shows, ascending
  std::vector<std::uint64_t> ray;     ///< [points] the place of each among all rays
  std::vector<std::uint32_t> first;   ///< [pixels + 1] contributions of each pixel that counts
  std::vector<std::uint32_t> local;   ///< [contributions] index into points
  std::vector<float> weight;          ///< [contributions] of sum 1 over a pixel
  std::vector<Colour4> photograph;    ///< [pixels] 0 .. 255
  std::vector<float> trust;           ///< [pixels] 0 .. 1

  std::size_t pixels() const { return photograph.size(); }
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
/// hidden_by, 0.75 GiB), every n-th camera shows something, the others nothing.
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
