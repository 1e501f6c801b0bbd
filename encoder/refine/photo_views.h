// SPDX-License-Identifier: Apache-2.0
// Photographs as geometry needs them: grey, at the scale of the points, with their cameras.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "capture/surface_points.h"
#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

/// One photograph reduced to grey and by 2^level in size.
struct PhotoView {
  const Camera* camera = nullptr;
  Vec3 centre{};
  double scale = 1;  ///< pixels of this image per pixel of the photograph
  int width = 0, height = 0;
  std::vector<float> grey;  ///< [height][width] 0 .. 255; NaN: masked

  /// Samples at image points (u, v) of this image, corner convention; NaN outside.
  float sample(float u, float v) const;
};

Result<std::vector<PhotoView>, InputError> load_views(const Capture& capture,
                                                      std::span<const int> cameras, int threads);
/// Half the size: means of 2 x 2.
PhotoView half(const PhotoView& view);

/// Where a line through space goes in an image, and what a step in the tangent plane does there.
struct PatchPath {
  std::array<double, 3> at{}, step{};  ///< homogeneous: (u w, v w, w) = at + offset * step
  std::array<float, 4> tangent{};      ///< du/da, dv/da, du/db, dv/db per unit of the tangents
};
std::optional<PatchPath> patch_path(const PhotoView& view, const Float3& position,
                                    const Float3& normal, const Float3& a, const Float3& b,
                                    double unit);

}  // namespace slf
