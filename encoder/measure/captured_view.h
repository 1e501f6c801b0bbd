// SPDX-License-Identifier: Apache-2.0
// What the capture's own surface is, and what of it a camera sees: the ground that pictures are
// judged on, the same for every codec. Spec annex D.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// The capture's points: what normals and visibility are judged by.
struct CapturedSurface {
  std::vector<std::array<float, 3>> normals;  ///< [capture's points]
  double spacing = 0;                         ///< world units; 0: a single point
};

/// The cloud's own normals, or estimated ones.
CapturedSurface captured_surface(const Capture& capture, int threads);

/// A pixel's place on the object.
enum class PictureRegionId : std::uint8_t { kGrazing, kRim, kRest };

/// Per pixel of one camera.
struct CapturedView {
  std::vector<std::uint8_t> object;     ///< 0 or 1: the photograph shows it
  std::vector<PictureRegionId> region;  ///< where it does
};

/// The object is where the photograph's alpha is 128 or more, else where the capture's points
/// project, each a disc that reaches the next ones. Grazing is where the ray and the surface make
/// an angle below 10 degrees: what the default delta leaves unobserved. Silhouettes and steps in
/// depth are between two neighbouring pixels of which one alone shows the object, or whose depths
/// differ by more than `depth_tolerance` (as observe has it); the rim is what has one within 2
/// pixels and is not grazing.
CapturedView captured_view(const Capture& capture, const CapturedSurface& surface,
                           const Camera& camera, const Image& photograph, double depth_tolerance);

}  // namespace slf
