// SPDX-License-Identifier: Apache-2.0
#include "lightfield/render/surfel_cloud.h"

#include <algorithm>

#include "lightfield/octahedral.h"
#include "lightfield/render/render_surfels.h"

namespace slf {
namespace {

constexpr float kMostShift = 0.6f;  // voxels; rounding moves a surface by no more than about half

}  // namespace

SurfelCloud surfel_cloud(const Grid& grid, std::span<const Voxel> positions,
                         const CodedNormals& coded, double radius_voxels, int threads) {
  Surfels surfels = estimate_surfels(positions, threads);
  SurfelCloud cloud;
  cloud.normals = std::move(surfels.normals);
  cloud.radii = std::move(surfels.radii);
  cloud.centres.resize(positions.size());
  cloud.areas.resize(positions.size());
  const bool has_coded = coded.bits > 0 && coded.octahedral.size() == positions.size();
  const auto step = static_cast<float>(grid.step);
  for (std::size_t p = 0; p < positions.size(); ++p) {
    auto& n = cloud.normals[p];
    if (has_coded) {
      const auto normal = dequantise_normal(coded.octahedral[p], coded.bits);
      n = {float(normal[0]), float(normal[1]), float(normal[2])};
    }
    if (radius_voxels > 0) cloud.radii[p] = static_cast<float>(radius_voxels);
    cloud.radii[p] *= step;
    cloud.areas[p] = surfels.spacings[p] * surfels.spacings[p] * step * step;
    // Along the normal onto the neighbours' plane: takes the voxels' staircase away.
    const auto& c = surfels.centroids[p];
    const float shift =
        std::clamp(n[0] * c[0] + n[1] * c[1] + n[2] * c[2], -kMostShift, kMostShift);
    for (std::size_t k = 0; k < 3; ++k)
      cloud.centres[p][k] =
          grid.origin[k] + double{step * (static_cast<float>(positions[p][k]) + shift * n[k])};
  }
  return cloud;
}

}  // namespace slf
