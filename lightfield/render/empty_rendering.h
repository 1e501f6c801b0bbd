// SPDX-License-Identifier: Apache-2.0
// A picture that is written piece by piece.
#pragma once

#include "lightfield/render/render_splats.h"
#include "slf/render.h"

namespace slf {

/// @param ended  or none: where it is set, arrays may be empty. Those of a large picture take the
///               greater part of a second.
inline Rendering empty_rendering(const Camera& camera, const std::atomic<bool>* ended = nullptr) {
  const std::size_t pixels = std::size_t(camera.width) * std::size_t(camera.height);
  Rendering out;
  out.image.width = camera.width;
  out.image.height = camera.height;
  if (!is_ended(ended)) out.image.data.resize(3 * pixels);
  if (!is_ended(ended)) out.coverage.resize(pixels);
  if (!is_ended(ended)) out.depth.resize(pixels);
  return out;
}

}  // namespace slf
