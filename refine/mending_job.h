// What the mending of a cloud works with: points, photographs, outlines, scales.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "capture/resample.h"
#include "refine/held_out.h"
#include "refine/photo_views.h"
#include "refine/refine_geometry.h"
#include "refine/silhouettes.h"

namespace slf {

inline constexpr std::size_t kLeastMendedPoints = 1000;  // fewer are nothing like a surface
inline constexpr std::size_t kJudgedPoints = 150'000;    // about as many tell a region's errors

/// What is mended, and by what.
struct MendingJob {
  const Capture& capture;
  std::span<const int> cameras;
  const RefineSettings& settings;
  CameraParts parts;
  SurfacePoints start;
  double spacing = 0;  ///< of the capture's points
  double pixel = 0;    ///< of the finest level used, world units at the object
  std::vector<std::vector<PhotoView>> levels;
  std::vector<Silhouette> outlines;  ///< of the photographs that are matched, where they bind
  std::vector<Silhouette> judged;    ///< of those held out
};

/// Photographs down to the size at which a pixel is about half a point spacing, and coarser, up to
/// level `coarsest`; `pixel`.
/// @errors those of load_image
Result<Done, InputError> load_photographs(MendingJob& job, int coarsest);
/// @errors those of load_image
Result<std::vector<Silhouette>, InputError> silhouettes_of(const MendingJob& job,
                                                           std::span<const int> cameras);

/// Errors of held-out photographs at about kJudgedPoints of the points, each for those around it.
Result<HeldOutErrors, InputError> sampled_errors(const MendingJob& job,
                                                 const SurfacePoints& points);

/// A lattice, and whether it is the one of the grid that follows.
struct MendingLattice {
  Lattice lattice;
  bool of_grid = false;
};

/// The lattice of the grid that follows, where that is not much finer than the points.
MendingLattice lattice_of(const SurfacePoints& surface, const MendingJob& job);

}  // namespace slf
