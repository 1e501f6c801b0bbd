// SPDX-License-Identifier: Apache-2.0
// Occlusion by a depth buffer of splatted points (paper III-A) or of triangles.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "slf/capture.h"

namespace slf {

struct DepthSettings {
  double resolution = 1;  ///< buffer pixels per image pixel
  double spacing = 0;     ///< of the occluders, world units
  double tolerance = 0;   ///< in spacings; 0: nearest point per pixel, each occluder one pixel
};

/// What one camera's nearest surface is, per pixel. With a tolerance each occluder covers a square
/// that reaches the next occluders, so that a surface has no holes through which points behind it
/// would be seen.
class DepthBuffer {
 public:
  /// Nothing is anywhere yet; what hides is added.
  DepthBuffer(const Camera& camera, const DepthSettings& settings);
  DepthBuffer(const Camera& camera, std::span<const std::array<float, 3>> occluders,
              const DepthSettings& settings);
  /// The depth of exact triangles, both sides of which hide: nothing is wider than it is.
  DepthBuffer(const Camera& camera, const Mesh& mesh, const DepthSettings& settings);

  /// Splats more occluders: the order does not matter.
  void add(const Camera& camera, std::span<const std::array<float, 3>> occluders);

  /// [height][width] of the buffer, +inf where nothing is: for keeping it.
  std::span<float> depths() { return depth_; }
  std::span<const float> depths() const { return depth_; }

  /// @param image  where the point is in the image, inside it
  /// @param depth  along the optical axis
  /// @param cosine  of the angle between the point's normal and the ray to the camera
  bool hides(const std::array<double, 2>& image, double depth, double cosine) const;

 private:
  struct Corner {
    double u, v;           ///< buffer pixels
    double inverse_depth;  ///< linear in the picture of a plane
  };

  void splat(const std::array<double, 2>& image, double depth);
  std::optional<Corner> corner(const Camera& camera, const Vec3& at) const;
  void fill(const Corner& a, const Corner& b, const Corner& c);

  DepthSettings settings_;
  double focal_;  // buffer pixels
  int width_, height_;
  std::vector<float> depth_;  // [height][width], +inf where nothing is
};

}  // namespace slf
