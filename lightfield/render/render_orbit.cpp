// SPDX-License-Identifier: Apache-2.0
// Cameras on a circle around the cloud.
#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/vec3.h"
#include "lightfield/render/orbit_camera.h"
#include "slf/render.h"

namespace slf {
namespace {

constexpr double kMargin = 1.03;  // around what is framed

/// Right-handed world axes with `up` third.
struct UpAxes {
  Vec3 first, second, up;
};

UpAxes up_axes(UpAxis axis) {
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

/// Seven finite numbers with a space between them.
std::optional<std::array<double, 7>> seven_numbers(const std::string& words) {
  std::array<double, 7> numbers{};
  const char *at = words.data(), *end = at + words.size();
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    if (i > 0 && (at == end || *at++ != ' ')) return {};
    const auto [stopped, error] = std::from_chars(at, end, numbers[i]);
    if (error != std::errc() || !std::isfinite(numbers[i])) return {};
    at = stopped;
  }
  if (at != end) return {};
  return numbers;
}

}  // namespace

std::optional<Camera> named_view(const Metadata& metadata, UpAxis up, int width, int height) {
  const auto named = std::find_if(metadata.begin(), metadata.end(),
                                  [](const auto& pair) { return pair.first == "view"; });
  if (named == metadata.end()) return {};
  const auto numbers = seven_numbers(named->second);
  if (!numbers || (*numbers)[6] < 1 || (*numbers)[6] > 170) return {};
  const Vec3 eye{(*numbers)[0], (*numbers)[1], (*numbers)[2]};
  const Vec3 target{(*numbers)[3], (*numbers)[4], (*numbers)[5]};
  const Vec3 back = combine(1, eye, -1, target, 0, eye);
  const double distance = std::sqrt(dot(back, back));
  if (!(distance > 0) || !std::isfinite(distance)) return {};
  const UpAxes axes = up_axes(up);
  const double turn = std::atan2(dot(back, axes.second), dot(back, axes.first));
  const double elevation = std::asin(std::clamp(dot(back, axes.up) / distance, -1.0, 1.0));
  const double radius = distance * std::sin((*numbers)[6] * std::numbers::pi / 360) / kMargin;
  Camera camera = orbit_camera({target, radius}, up,
                               {turn / (2 * std::numbers::pi), elevation * 180 / std::numbers::pi,
                                width, height, (*numbers)[6]});
  camera.name = "view";
  return camera;
}

Camera orbit_camera(const FramedBall& ball, UpAxis up, const OrbitView& view) {
  const UpAxes axes = up_axes(up);
  const double azimuth = 2 * std::numbers::pi * view.turn;
  const double elevation = view.elevation_degrees * std::numbers::pi / 180;
  const double half_fov = std::clamp(view.fov_degrees, 1.0, 170.0) * std::numbers::pi / 360;
  const double ca = std::cos(azimuth), sa = std::sin(azimuth);
  const double ce = std::cos(elevation), se = std::sin(elevation);
  // Down is the elevation's derivative, so that it is defined straight above and below as well.
  const Vec3 right = combine(-sa, axes.first, ca, axes.second, 0, axes.up);
  const Vec3 down = combine(se * ca, axes.first, se * sa, axes.second, -ce, axes.up);
  const Vec3 forward = combine(-ce * ca, axes.first, -ce * sa, axes.second, -se, axes.up);

  const double distance = kMargin * ball.radius / std::sin(half_fov);
  Camera camera;
  camera.name = "orbit";
  camera.width = view.width;
  camera.height = view.height;
  camera.fx = camera.fy = std::min(view.width, view.height) / (2 * std::tan(half_fov));
  camera.cx = view.width / 2.0;
  camera.cy = view.height / 2.0;
  camera.rotation = {right, down, forward};
  camera.translation = {-dot(right, ball.centre), -dot(down, ball.centre),
                        distance - dot(forward, ball.centre)};
  return camera;
}

Camera Renderer::orbit(double turn, double elevation_degrees, int width, int height,
                       double fov_degrees) const {
  FramedBall ball = framed_ball(maps_.header().grid, maps_.positions());
  ball.radius += maps_.header().grid.step;  // more than a voxel's half width
  return orbit_camera(ball, maps_.header().up,
                      {turn, elevation_degrees, width, height, fov_degrees});
}

}  // namespace slf
