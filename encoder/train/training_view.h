// SPDX-License-Identifier: Apache-2.0
// A photograph as the trainer needs it: without distortion, over a plain background, at a size.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "capture/surface_points.h"
#include "encoder/train/training_cache.h"
#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

/// A pinhole camera in floats.
struct TrainingCamera {
  int width = 0, height = 0;
  float fx = 0, fy = 0, cx = 0, cy = 0;
  std::array<Float3, 3> rotation{};  ///< rows
  Float3 translation{}, centre{};    ///< centre: world
  float depth = 1;                   ///< of what it looks at, about: unit of inverse depths
  /// Surfels are drawn as 3DGS draws them, not with the reference kernel.
  bool gaussian = false;

  Float3 in_camera(const Float3& at) const {
    return {dot(rotation[0], at) + translation[0], dot(rotation[1], at) + translation[1],
            dot(rotation[2], at) + translation[2]};
  }
};

/// Three planes of colours, 0 .. 1.
struct PlanarPicture {
  int width = 0, height = 0;
  std::vector<float> value;  ///< [3][height][width]

  std::size_t pixels() const { return std::size_t(width) * std::size_t(height); }
  float* plane(std::size_t c) { return value.data() + c * pixels(); }
  const float* plane(std::size_t c) const { return value.data() + c * pixels(); }
};

struct TrainingView {
  int index = 0;  ///< of the capture's cameras
  TrainingCamera camera;
  PlanarPicture picture;
  Float3 background{};  ///< what is seen where no surfel is
  /// [height][width] what it costs to hide all of the background; empty: nothing anywhere.
  std::vector<float> hiding;
};

/// Photographs with sides of a 2^log2-th, of `cameras`, in their order.
/// @param surface  what they look at: for depths, and to tell the background
/// @param cache  nullptr: none
/// @errors those of load_image
Result<std::vector<TrainingView>, InputError> load_training_views(
    const Capture& capture, std::span<const int> cameras, const SurfacePoints& surface,
    double spacing, int log2, int threads, TrainingCache* cache = nullptr);

/// With sides of half the size, each pixel the mean of four; an odd last row or column is dropped.
TrainingView half(const TrainingView& view);

}  // namespace slf
