// SPDX-License-Identifier: Apache-2.0
// One camera that looks along +z, and what it sees of points in front of it.
#pragma once

#include <array>
#include <vector>

#include "encoder/fit/observe_camera.h"

namespace slf::test {

inline constexpr std::array<float, 3> kTowards{0, 0, -1};  // a normal that faces the camera
using Points = std::vector<std::array<float, 3>>;

/// 8 x 6 pixels, focal length 10, principal point at the middle, at the origin.
inline Camera small_camera() {
  Camera camera;
  camera.name = "a";
  camera.width = 8;
  camera.height = 6;
  camera.fx = camera.fy = 10;
  camera.cx = 4;
  camera.cy = 3;
  return camera;
}

/// Red 10 x, green 20 y, blue 7 at pixel (x, y).
inline Image ramp(int channels = 3) {
  Image image{8, 6, channels, {}};
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 8; ++x) {
      for (const int value : {10 * x, 20 * y, 7})
        image.data.push_back(static_cast<std::uint8_t>(value));
      if (channels == 4) image.data.push_back(255);
    }
  return image;
}

/// The point that projects to (u, v) at a depth.
inline std::array<float, 3> at(double u, double v, double depth) {
  return {static_cast<float>((u - 4) / 10 * depth), static_cast<float>((v - 3) / 10 * depth),
          static_cast<float>(depth)};
}

inline std::vector<Sighting> see(const ObservedPoints& points, const Points& occluders,
                                 const ObserveSettings& settings, const Image& image = ramp(),
                                 double spacing = 0.1) {
  const DepthBuffer depth(small_camera(), occluders,
                          {settings.occlusion_resolution, spacing, settings.depth_tolerance});
  return CameraObserver(points, settings).observe(small_camera(), image, depth).sightings;
}

inline bool sees(const std::array<float, 3>& point, const Points& occluders,
                 const ObserveSettings& settings, const std::array<float, 3>& normal = kTowards) {
  return !see({{point}, {normal}}, occluders, settings).empty();
}

}  // namespace slf::test
