// SPDX-License-Identifier: Apache-2.0
// Points of a mesh, as many as a grid has voxels on it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "capture/voxelise.h"
#include "slf/capture.h"

namespace slf {

/// Lines through the centres of a grid's voxels, along its three axes, meet the triangles: a
/// crossing counts for the axis that the triangle's normal is closest to. So the grid gets a closed
/// layer of voxels one thick, hardly any of them twice, and a point lies on the surface itself.
/// Where a normal lies between two axes, crossings of both are kept if their voxel has no other
/// point: neither side of an edge may count on the other.
/// Normals are the vertices', interpolated, or else the face's; colours the vertices'.
/// @param grid  its bits are not looked at
/// @return in the order of triangles; may be empty, where no line meets a triangle
/// @errors kInvalidInput: more than 2^24 points or 2^27 lines to look at: the step is too small.
/// The same on every run. O(points + F).
Result<PointCloud, InputError> sample_mesh(const Mesh& mesh, const Grid& grid);

/// A cube of a grid's voxels, with the triangles that may have points in it.
struct MeshWindow {
  Voxel low{}, high{};                       ///< both belong to it
  std::span<const std::uint32_t> triangles;  ///< ascending
};

/// Those points of sample_mesh whose voxels are in the window.
/// @errors kInvalidInput: more than 2^24 points
Result<PointCloud, InputError> sample_mesh_in(const Mesh& mesh, const Grid& grid,
                                              const MeshWindow& window);

/// The step of a mesh's automatic grid: kPixelsPerVoxel pixels, or what kMostAutomaticPoints take.
double automatic_step(const Mesh& mesh, double pixel);

/// The sample on the automatic grid of all cameras (choose_density). Where none sees the mesh,
/// 1/255 of its extent stands in for their pixels: the capture will be refused, or warned about.
Result<PointCloud, InputError> sample_for_cameras(const Capture& capture, const Mesh& mesh);

}  // namespace slf
