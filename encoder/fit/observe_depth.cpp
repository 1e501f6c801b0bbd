// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/observe_depth.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slf {
namespace {

int buffer_size(int image_pixels, double resolution) {
  return std::max(1, static_cast<int>(std::ceil(image_pixels * resolution)));
}

/// floor(x) limited to 0 .. size; x may be far outside of int, or NaN (0).
int limited_floor(double x, int size) {
  return x > 0 ? static_cast<int>(std::min(x, static_cast<double>(size))) : 0;
}

double depth_of(const Camera& camera, const Vec3& at) {
  double z = camera.translation[2];
  for (std::size_t a = 0; a < 3; ++a) z += camera.rotation[2][a] * at[a];
  return z;
}

/// The part of a triangle that is before the camera: 0, 3 or 4 corners.
struct Before {
  std::array<Vec3, 4> corners{};
  std::size_t count = 0;
};

Before before_camera(const Camera& camera, const std::array<Vec3, 3>& triangle) {
  constexpr double kNearestShare = 1e-3;  // of the farthest corner's depth
  std::array<double, 3> depth{};
  for (std::size_t i = 0; i < 3; ++i) depth[i] = depth_of(camera, triangle[i]);
  const double near = kNearestShare * *std::max_element(depth.begin(), depth.end());
  Before part;
  if (!(near > 0)) return part;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (depth[i] >= near) part.corners[part.count++] = triangle[i];
    if ((depth[i] >= near) == (depth[j] >= near)) continue;
    const double t = (near - depth[i]) / (depth[j] - depth[i]);
    Vec3& crossing = part.corners[part.count++];
    for (std::size_t a = 0; a < 3; ++a)
      crossing[a] = triangle[i][a] + t * (triangle[j][a] - triangle[i][a]);
  }
  return part;
}

}  // namespace

DepthBuffer::DepthBuffer(const Camera& camera, const Mesh& mesh, const DepthSettings& settings)
    : DepthBuffer(camera, settings) {
  for (const auto& triangle : mesh.triangles) {
    std::array<Vec3, 3> world{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto& at = mesh.vertices.positions[triangle[i]];
      world[i] = {double{at[0]}, double{at[1]}, double{at[2]}};
    }
    const Before part = before_camera(camera, world);
    std::array<std::optional<Corner>, 4> corners{};
    for (std::size_t i = 0; i < part.count; ++i) corners[i] = corner(camera, part.corners[i]);
    for (std::size_t i = 2; i < part.count; ++i)
      if (corners[0] && corners[i - 1] && corners[i])
        fill(*corners[0], *corners[i - 1], *corners[i]);
  }
}

DepthBuffer::DepthBuffer(const Camera& camera, const DepthSettings& settings)
    : settings_(settings),
      focal_(std::max(camera.fx, camera.fy) * settings.resolution),
      width_(buffer_size(camera.width, settings.resolution)),
      height_(buffer_size(camera.height, settings.resolution)),
      depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
             std::numeric_limits<float>::infinity()) {}

DepthBuffer::DepthBuffer(const Camera& camera, std::span<const std::array<float, 3>> occluders,
                         const DepthSettings& settings)
    : DepthBuffer(camera, settings) {
  add(camera, occluders);
}

void DepthBuffer::add(const Camera& camera, std::span<const std::array<float, 3>> occluders) {
  for (const auto& point : occluders) {
    double depth = 0;
    if (const auto image = camera.project({point[0], point[1], point[2]}, &depth))
      splat(*image, depth);
  }
}

void DepthBuffer::splat(const std::array<double, 2>& image, double depth) {
  const double u = image[0] * settings_.resolution, v = image[1] * settings_.resolution;
  // Pixels whose centre is within one spacing; without a tolerance the one pixel that holds (u, v).
  const double half =
      settings_.tolerance > 0 ? std::max(0.5, settings_.spacing * focal_ / depth) : 0.5;
  const int left = limited_floor(u - half + 0.5, width_),
            right = limited_floor(u + half + 0.5, width_);
  const int top = limited_floor(v - half + 0.5, height_),
            end = limited_floor(v + half + 0.5, height_);
  const auto nearest = static_cast<float>(depth);
  for (int y = top; y < end; ++y) {
    float* row = depth_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = left; x < right; ++x) row[x] = std::min(row[x], nearest);
  }
}

std::optional<DepthBuffer::Corner> DepthBuffer::corner(const Camera& camera, const Vec3& at) const {
  double depth = 0;
  const auto image = camera.project(at, &depth);
  if (!image || !(depth > 0)) return {};
  return Corner{(*image)[0] * settings_.resolution, (*image)[1] * settings_.resolution, 1 / depth};
}

void DepthBuffer::fill(const Corner& a, const Corner& b, const Corner& c) {
  const double area = (b.u - a.u) * (c.v - a.v) - (c.u - a.u) * (b.v - a.v);
  if (!(std::abs(area) > 0)) return;
  const auto [left, right] = std::minmax({a.u, b.u, c.u});
  const auto [top, bottom] = std::minmax({a.v, b.v, c.v});
  const int x_end = limited_floor(right + 0.5, width_),
            y_end = limited_floor(bottom + 0.5, height_);
  // Shares of the corners at pixel centres; edges belong to both of their triangles.
  const auto share = [area](const Corner& from, const Corner& to, double u, double v) {
    return ((to.u - from.u) * (v - from.v) - (u - from.u) * (to.v - from.v)) / area;
  };
  for (int y = limited_floor(top, height_); y < y_end; ++y) {
    float* row = depth_.data() + static_cast<std::size_t>(y) * static_cast<std::size_t>(width_);
    for (int x = limited_floor(left, width_); x < x_end; ++x) {
      const double u = x + 0.5, v = y + 0.5;
      const double of_a = share(b, c, u, v), of_b = share(c, a, u, v), of_c = share(a, b, u, v);
      if (!(of_a >= 0 && of_b >= 0 && of_c >= 0)) continue;
      const double inverse =
          of_a * a.inverse_depth + of_b * b.inverse_depth + of_c * c.inverse_depth;
      row[x] = std::min(row[x], static_cast<float>(1 / inverse));
    }
  }
}

bool DepthBuffer::hides(const std::array<double, 2>& image, double depth, double cosine) const {
  const int x = std::min(limited_floor(image[0] * settings_.resolution, width_), width_ - 1);
  const int y = std::min(limited_floor(image[1] * settings_.resolution, height_), height_ - 1);
  const float nearest = depth_[static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                               static_cast<std::size_t>(x)];
  if (settings_.tolerance <= 0) return static_cast<float>(depth) > nearest;
  // A surface slanted by the view angle spans this depth around a splat. Where pixels are wider
  // than the spacing, the nearest point of a pixel is up to a pixel away from the others in it.
  const double reach = std::max(settings_.spacing, depth / focal_);
  return depth - static_cast<double>(nearest) >
         settings_.tolerance * reach / std::max(cosine, 1e-3);
}

}  // namespace slf
