// SPDX-License-Identifier: Apache-2.0
// Gaussian splats as their renderer holds them, and as a camera sees them. Kerbl, Kopanas,
// Leimkuehler, Drettakis, "3D Gaussian splatting for real-time radiance field rendering" (2023),
// with the projection of Zwicker et al., "EWA splatting" (2002).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "lightfield/render/framed_ball.h"
#include "slf/capture.h"
#include "slf/gaussians.h"

namespace slf {

/// The constants of the reference implementation.
struct GaussianKernel {
  static constexpr float filter = 0.3f;  ///< pixels squared, added to the variance along both axes
  static constexpr float least_alpha = 1.0f / 255, most_alpha = 0.99f;
  static constexpr float least_clear = 1e-4f;   ///< of a pixel, below which it is done
  static constexpr double nearest = 0.2;        ///< depth in front of which nothing is drawn
  static constexpr double frustum_share = 1.3;  ///< of half a picture's tangent, where the
                                                ///< derivative of the projection is clamped
};

/// What does not depend on the camera.
struct GaussianShape {
  std::array<float, 6> covariance;  ///< xx, xy, xz, yy, yz, zz; world units squared
  float opacity;                    ///< 0 .. 1
  float reach;  ///< squared deviations at which alpha is least_alpha; 0 or less: it never shows
};

struct GaussianCloud {
  std::vector<GaussianShape> shapes;  ///< [P]
  FramedBall ball;
  double nearest = GaussianKernel::nearest;  ///< less where the scene is small
};

GaussianCloud gaussian_cloud(const Gaussians& gaussians, int threads);

/// A splat in the image: opacity * exp(-(a x^2 + 2 b x y + c y^2) / 2) around (u, v). One line of a
/// cache.
struct alignas(64) ProjectedGaussian {
  float u, v;     ///< pixels, centre of the top left pixel at (0.5, 0.5)
  float a, b, c;  ///< inverse of the filtered covariance, 1 / pixel^2
  float opacity;
  float reach;                    ///< as the shape has it
  float half_width, half_height;  ///< of the box within the reach, pixels
  float red, green, blue;         ///< 0 and more, 1 = display white
  float depth;
};

/// Those that may show, nearest first; those of equal depth in the order of the file.
std::vector<ProjectedGaussian> project_gaussians(const Gaussians& gaussians,
                                                 const GaussianCloud& cloud, const Camera& camera,
                                                 bool view_dependent, int threads);

}  // namespace slf
