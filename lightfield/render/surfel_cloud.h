// SPDX-License-Identifier: Apache-2.0
// The discs that stand for the points of a light field, and their splats in a camera.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "lightfield/render/render_splats.h"
#include "slf/capture.h"
#include "slf/types.h"

namespace slf {

/// One disc per point, in point order.
struct SurfelCloud {
  std::vector<Vec3> centres;                  ///< [P] world
  std::vector<std::array<float, 3>> normals;  ///< [P] unit, of either sign; 0: faces the camera
  std::vector<float> radii;                   ///< [P] world units
  std::vector<float> areas;                   ///< [P] of the surface that each stands for

  std::size_t size() const { return centres.size(); }
};

/// Discs that together cover the surface that the voxels are samples of: normals as coded, else
/// estimated; centres moved along them onto the neighbours' plane.
/// @param coded  normals of the points; without any where bits is 0
/// @param radius_voxels  of every disc; 0: from the spacing around each
SurfelCloud surfel_cloud(const Grid& grid, std::span<const Voxel> positions,
                         const CodedNormals& coded, double radius_voxels, int threads);

/// Splats of all discs that the camera can see, in point order.
/// @param ended  or none: where it is set, some are missing
std::vector<Splat> project_surfels(const SurfelCloud& cloud, const Camera& camera, int threads,
                                   const std::atomic<bool>* ended = nullptr);

}  // namespace slf
