#include "lightfield/observe_depth.h"

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

}  // namespace

DepthBuffer::DepthBuffer(const Camera& camera, std::span<const std::array<float, 3>> occluders,
                         const DepthSettings& settings)
    : settings_(settings),
      focal_(std::max(camera.fx, camera.fy) * settings.resolution),
      width_(buffer_size(camera.width, settings.resolution)),
      height_(buffer_size(camera.height, settings.resolution)),
      depth_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_),
             std::numeric_limits<float>::infinity()) {
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
