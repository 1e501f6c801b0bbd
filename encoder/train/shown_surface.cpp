// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/shown_surface.h"

#include <algorithm>
#include <limits>

namespace slf {
namespace {

/// Least of the values within kEdgePixels along rows or columns.
void spread_least(std::vector<float>& values, std::size_t width, std::size_t height,
                  std::size_t stride, std::size_t length) {
  const std::vector<float> from = values;
  for (std::size_t y = 0; y < height; ++y)
    for (std::size_t x = 0; x < width; ++x) {
      const std::size_t i = y * width + x, along = i / stride % length;
      for (std::size_t k = 1; k <= std::size_t(kEdgePixels); ++k) {
        if (along >= k) values[i] = std::min(values[i], from[i - k * stride]);
        if (along + k < length) values[i] = std::min(values[i], from[i + k * stride]);
      }
    }
}

std::vector<float> nearest_around(const std::vector<float>& depth, const TrainingCamera& camera) {
  std::vector<float> nearest = depth;
  for (float& z : nearest)
    if (!(z > 0)) z = std::numeric_limits<float>::infinity();
  const auto width = std::size_t(camera.width), height = std::size_t(camera.height);
  spread_least(nearest, width, height, 1, width);
  spread_least(nearest, width, height, width, height);
  return nearest;
}

}  // namespace

Float3 ShownSurface::point(std::size_t pixel) const {
  const TrainingCamera& c = *camera;
  const float z = depths.depth[pixel];
  const std::size_t column = pixel % std::size_t(c.width), row = pixel / std::size_t(c.width);
  const float x = (float(column) + 0.5f - c.cx) / c.fx * z;
  const float y = (float(row) + 0.5f - c.cy) / c.fy * z;
  return along(along(along(c.centre, x, c.rotation[0]), y, c.rotation[1]), z, c.rotation[2]);
}

ShownSurface shown_surface(const TrainedSurfels& surfels, const TrainingView& view, int threads) {
  ShownSurface shown;
  shown.camera = &view.camera;
  shown.depths = surfel_depths(tile_surfels(surfels, view.camera, threads), view.camera, threads);
  shown.nearest = nearest_around(shown.depths.depth, view.camera);
  for (const TrainedSurfel& surfel : surfels) {
    Float3 normal = axes_of(surfel).normal;
    if (dot(normal, minus(view.camera.centre, surfel.position())) < 0)
      normal = {-normal[0], -normal[1], -normal[2]};
    shown.normals.push_back(normal);
  }
  return shown;
}

}  // namespace slf
