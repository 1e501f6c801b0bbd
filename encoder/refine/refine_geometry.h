// SPDX-License-Identifier: Apache-2.0
// Mends a capture's cloud where photographs disagree about it. Encoder only, before voxelisation.
#pragma once

#include <functional>
#include <span>

#include "slf/capture.h"
#include "slf/error.h"
#include "slf/refine.h"
#include "slf/types.h"

namespace slf {

struct RefineSettings {
  RefineGeometry mode = RefineGeometry::kAuto;
  int grid_bits = 9;       ///< of the grid that follows
  double voxel_size = 0;   ///< > 0: in place of grid_bits
  bool free_grid = false;  ///< a mended surface may have a coarser one than both
  int threads = 0;
  /// Asked once by kAuto, of points that are not exact. False leaves them as they are.
  std::function<Result<bool, InputError>()> pays = {};
};

struct RefinedCloud {
  PointCloud cloud;  ///< kMended: positions and normals; empty otherwise
  /// > 0: the points lie on a lattice of this step; voxelise with it, or they alias with the grid.
  double voxel_size = 0;
  RefineReport report;
};

/// Moves points along their normals to where patches of the photographs agree (normalised
/// correlation, the best of the cameras that face the point and see it), smoothly over the surface,
/// coarse to fine; samples the surface anew after each round; goes back to the capture's points
/// wherever photographs left out of all this are predicted no better, or would show what is behind
/// the object. Where that still tears it, once more with outlines held where the photographs have
/// them; and if that tears it too, nothing is changed.
/// @param cameras  the input cameras: no other photograph is looked at
/// @errors those of load_image and observe.
/// The same for any thread count. O(points * offsets * cameras per point * samples of a patch);
/// memory: the photographs as floats, at about two pixels a point spacing or coarser.
Result<RefinedCloud, InputError> refine_geometry(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const RefineSettings& settings,
                                                 const Progress& progress = {});

}  // namespace slf
