// Cameras on a circle around the cloud.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec3.h"
#include "render/framed_ball.h"
#include "slf/render.h"

namespace slf {
namespace {

/// Right-handed world axes with `up` third.
struct UpFrame {
  Vec3 first, second, up;
};

UpFrame up_frame(UpAxis axis) {
  switch (axis) {
    case UpAxis::kPlusX:
      return {{0, 1, 0}, {0, 0, 1}, {1, 0, 0}};
    case UpAxis::kMinusX:
      return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
    case UpAxis::kPlusY:
      return {{0, 0, 1}, {1, 0, 0}, {0, 1, 0}};
    case UpAxis::kMinusY:
      return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
    case UpAxis::kMinusZ:
      return {{0, 1, 0}, {1, 0, 0}, {0, 0, -1}};
    case UpAxis::kPlusZ:
    case UpAxis::kUnknown:
      break;
  }
  return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
}

Vec3 combine(double a, const Vec3& u, double b, const Vec3& v, double c, const Vec3& w) {
  return {a * u[0] + b * v[0] + c * w[0], a * u[1] + b * v[1] + c * w[1],
          a * u[2] + b * v[2] + c * w[2]};
}

}  // namespace

Camera Renderer::orbit(double turn, double elevation_degrees, int width, int height,
                       double fov_degrees) const {
  const UpFrame frame = up_frame(maps_.header().up);
  const FramedBall ball = framed_ball(maps_.header().grid, maps_.positions());
  const double azimuth = 2 * std::numbers::pi * turn;
  const double elevation = elevation_degrees * std::numbers::pi / 180;
  const double half_fov = std::clamp(fov_degrees, 1.0, 170.0) * std::numbers::pi / 360;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth);
  const double ce = std::cos(elevation), se = std::sin(elevation);
  // Down is the elevation's derivative, so that it is defined straight above and below as well.
  const Vec3 right = combine(-sa, frame.first, ca, frame.second, 0, frame.up);
  const Vec3 down = combine(se * ca, frame.first, se * sa, frame.second, -ce, frame.up);
  const Vec3 forward = combine(-ce * ca, frame.first, -ce * sa, frame.second, -se, frame.up);

  // A voxel's half width and a margin of 3 % around the ball.
  const double radius = 1.03 * (ball.radius + maps_.header().grid.step);
  const double distance = radius / std::sin(half_fov);
  Camera camera;
  camera.name = "orbit";
  camera.width = width;
  camera.height = height;
  camera.fx = camera.fy = std::min(width, height) / (2 * std::tan(half_fov));
  camera.cx = width / 2.0;
  camera.cy = height / 2.0;
  camera.rotation = {right, down, forward};
  camera.translation = {-dot(right, ball.centre), -dot(down, ball.centre),
                        distance - dot(forward, ball.centre)};
  return camera;
}

}  // namespace slf
