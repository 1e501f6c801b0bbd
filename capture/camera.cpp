// SPDX-License-Identifier: Apache-2.0
// The pinhole camera with Brown distortion.
#include <cmath>

#include "slf/capture.h"

namespace slf {

namespace {

// The radial factor 1 + k1 r^2 + k2 r^4 moves points outwards only while r times it grows. Beyond
// its first extremum the polynomial folds far-off points back into the image; no lens does that.
bool beyond_fold(double k1, double k2, double r2) {
  // d/dr (r + k1 r^3 + k2 r^5) = 1 + 3 k1 s + 5 k2 s^2 with s = r^2: beyond its smallest root s >
  // 0?
  const double a = 5 * k2, b = 3 * k1;
  const double discriminant = b * b - 4 * a;
  if (discriminant < 0) return false;
  // Both roots without cancellation: 2 / (-b ± sqrt). A denominator <= 0 is no positive root; the
  // larger denominator is the smaller root.
  const double denominator = -b + std::sqrt(discriminant);
  return denominator > 0 && r2 >= 2 / denominator;
}

}  // namespace

Vec3 Camera::centre() const {
  Vec3 c{};
  for (std::size_t i = 0; i < 3; ++i)
    c[i] = -(rotation[0][i] * translation[0] + rotation[1][i] * translation[1] +
             rotation[2][i] * translation[2]);
  return c;
}

Vec3 Camera::in_camera(const Vec3& at) const {
  Vec3 p{};
  for (std::size_t i = 0; i < 3; ++i)
    p[i] =
        rotation[i][0] * at[0] + rotation[i][1] * at[1] + rotation[i][2] * at[2] + translation[i];
  return p;
}

Camera moved(Camera camera, const Vec3& by) {
  for (std::size_t i = 0; i < 3; ++i)
    camera.translation[i] -= camera.rotation[i][0] * by[0] + camera.rotation[i][1] * by[1] +
                             camera.rotation[i][2] * by[2];
  return camera;
}

Camera reduced(Camera camera, int log2) {
  const double scale = std::ldexp(1, -log2);
  for (double* x : {&camera.fx, &camera.fy, &camera.cx, &camera.cy}) *x *= scale;
  for (int* side : {&camera.width, &camera.height})
    *side = static_cast<int>(std::ceil(*side * scale));
  return camera;
}

std::optional<std::array<double, 2>> Camera::project(const Vec3& world, double* z) const {
  const Vec3 p = in_camera(world);
  if (z != nullptr) *z = p[2];
  if (!(p[2] > 0)) return std::nullopt;
  double x = p[0] / p[2], y = p[1] / p[2];
  const auto [k1, k2, p1, p2] = distortion;
  if (k1 != 0 || k2 != 0 || p1 != 0 || p2 != 0) {
    // COLMAP's OPENCV model.
    const double r2 = x * x + y * y;
    if (beyond_fold(k1, k2, r2)) return std::nullopt;
    const double radial = r2 * (k1 + k2 * r2);
    const double dx = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
    const double dy = y * radial + 2 * p2 * x * y + p1 * (r2 + 2 * y * y);
    x += dx;
    y += dy;
  }
  const std::array<double, 2> image{fx * x + cx, fy * y + cy};
  if (!std::isfinite(image[0]) || !std::isfinite(image[1])) return std::nullopt;
  return image;
}

}  // namespace slf
