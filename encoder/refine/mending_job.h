// SPDX-License-Identifier: Apache-2.0
// What the mending of a cloud works with: points, photographs, outlines, scales.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "capture/resample.h"
#include "encoder/measure/outlines.h"
#include "encoder/refine/held_out.h"
#include "encoder/refine/photo_views.h"
#include "encoder/refine/refine_geometry.h"
#include "encoder/refine/silhouettes.h"

namespace slf {

inline constexpr std::size_t kLeastMendedPoints = 1000;  // fewer are nothing like a surface
inline constexpr std::size_t kJudgedPoints = 150'000;    // about as many tell a region's errors

/// What is mended, and by what.
struct MendingJob {
  const Capture& capture;
  std::span<const int> cameras;
  const RefineSettings& settings;
  CameraParts parts;
  SurfacePoints captured;  ///< the capture's, where those that are mended are fewer
  SurfacePoints start;     ///< what is mended
  double captured_spacing = 0, spacing = 0;  ///< of the capture's points, and of `start`
  double pixel = 0;  ///< of the finest level used, world units at the object
  std::vector<std::vector<PhotoView>> levels;
  std::vector<Silhouette> outlines;  ///< of the photographs that are matched, where they bind
  std::vector<Silhouette> judged;    ///< of those held out
  std::vector<Outline> hull;         ///< of the photographs that are matched, where they tell one
  double given_error = 0;  ///< mean square of held-out photographs, by the capture's points

  bool thinned() const { return captured.size() > 0; }
};

/// Are points nearer to one another than the photographs of `level` tell apart?
bool is_dense(const MendingJob& job, int level);
/// Where they are: points that those photographs tell apart in their place, more of which say the
/// same again.
void thin_start(MendingJob& job, int level);

/// Photographs down to the size at which a pixel is about half a point spacing, and coarser, up to
/// level `coarsest`; `pixel`.
/// @errors those of load_image
Result<Done, InputError> load_photographs(MendingJob& job, int coarsest);
/// @errors those of load_image
Result<Done, InputError> find_hull(MendingJob& job);
/// Brings a surface inside of the hull, if there is one.
/// @param slack  pixels: so near to an outline it is inside
void carve_surface(const MendingJob& job, double slack, SurfacePoints& surface);
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
/// The same of what is mended in the end; of points that were thinned as fine as photographs
/// resolve.
MendingLattice final_lattice_of(const SurfacePoints& surface, const MendingJob& job);
/// About as fine as the capture's points.
Lattice lattice_of_captured(const SurfacePoints& surface, const MendingJob& job);

/// For points that lie `spacing` apart: holes close also on a lattice finer than they are.
ResampleSettings sampling_of(double spacing, const Lattice& lattice, int threads);

}  // namespace slf
