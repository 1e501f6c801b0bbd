// SPDX-License-Identifier: Apache-2.0
// A picture that is written piece by piece.
#pragma once

#include "slf/render.h"

namespace slf {

inline Rendering empty_rendering(const Camera& camera) {
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  Rendering out;
  out.image.width = camera.width;
  out.image.height = camera.height;
  out.image.data.resize(3 * pixels);
  out.coverage.resize(pixels);
  out.depth.resize(pixels);
  return out;
}

}  // namespace slf
