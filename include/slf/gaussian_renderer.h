// SPDX-License-Identifier: Apache-2.0
// Images of Gaussian splats, on the CPU.
#pragma once

#include <memory>

#include "slf/gaussians.h"
#include "slf/render.h"

namespace slf {

struct GaussianCloud;

/// Draws splats as their reference implementation does (Kerbl et al. 2023): each an ellipse of the
/// picture by the derivative of the projection at its centre (Zwicker et al., "EWA splatting",
/// 2002), widened by 0.3 pixels squared, blended from the nearest to the farthest by the depth of
/// centres. What is less opaque than 1/255 is not drawn; 0.99 is the most. A pixel is done when
/// less than 1/10000 of it is clear. There are no tiles to be seen: a splat ends where its opacity
/// is 1/255, wherever that is. Distortion of the camera is honoured at centres. Deterministic for
/// any thread count. Several threads may render at a time.
class GaussianRenderer {
 public:
  /// Precomputes covariances; keeps a reference to `gaussians`, which may be empty,
  /// and are what check_gaussians() accepts.
  /// @param settings  `radius` has no meaning here
  /// O(splats).
  explicit GaussianRenderer(const Gaussians& gaussians, const RenderSettings& settings = {});
  explicit GaussianRenderer(Gaussians&&,
                            const RenderSettings& = {}) = delete;  // they would be gone

  /// Coverage is what the splats leave of the background, taken from 1; depth that of the centre
  /// with which half of the pixel is covered, +inf where less is. Colours are display values,
  /// clamped to 0 .. 255.
  /// O(splats + pixels that they cover).
  /// @param ended  as of Renderer::render
  Rendering render(const Camera& camera, const std::atomic<bool>* ended = nullptr) const;

  /// As Renderer::orbit: about most of the centres, without a few that are far away.
  Camera orbit(double turn, double elevation_degrees, int width, int height,
               double fov_degrees = 30) const;

 private:
  const Gaussians& gaussians_;
  RenderSettings settings_;
  std::shared_ptr<const GaussianCloud> cloud_;
};

}  // namespace slf
