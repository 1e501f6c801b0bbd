// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/mend_rounds.h"

#include <algorithm>
#include <cmath>

#include "encoder/refine/offset_field.h"
#include "encoder/refine/photo_consistency.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/decisions/019.
constexpr std::size_t kNear = 24;         // points of a plane
constexpr double kReach = 1.5;            // spacings: of a neighbour's influence
constexpr std::size_t kNearOffsets = 12;  // points whose offsets agree
constexpr int kFirstSmoothings = 2;       // the steps of a voxel grid are no surface
constexpr double kPixelsApart = 0.5;      // of a round's photographs, between points: with more
                                          // they say the same again
constexpr std::size_t kFewest = 4000;     // points that a round has, where the capture has them
constexpr double kThinned = 1.2;          // times farther apart: worth it

/// Positions on the surface that their neighbours make, and its normals.
void smooth(SurfacePoints& surface, double spacing, int threads) {
  const SurfaceNeighbours near = find_neighbours(surface, kNear, kReach * spacing, threads);
  surface.normals = plane_normals(surface, near, threads);
  move_along_normals(surface, distance_to_neighbours(surface, near, threads));
}

/// Width of a pixel of a round's photographs, world units at the object.
double pixel_of(const MendingJob& job, std::size_t round) {
  return job.pixel * std::pow(2.0, kMendingLevels[round]);
}

/// Between the points that a round moves: those of the capture, or as many as its photographs tell
/// apart.
double spacing_of(const MendingJob& job, std::size_t round) {
  const double points = double(job.start.size()) / double(kFewest);
  return std::max(job.spacing,
                  std::min(kPixelsApart * pixel_of(job, round), job.spacing * std::sqrt(points)));
}

/// The surface anew, at the nodes of a lattice or beside them, for a round or at the end.
/// @param spacing  of its points
SurfacePoints sampled(const MendingJob& job, const SurfacePoints& surface, double spacing,
                      std::size_t next_round) {
  Lattice lattice = lattice_of(surface, job).lattice;
  lattice.size = {};
  if (next_round < kMendingLevels.size() && spacing_of(job, next_round) > job.spacing)
    lattice.step = std::max(lattice.step, spacing_of(job, next_round));
  return resample(surface, lattice, sampling_of(spacing, lattice, job.settings.threads));
}

/// As a round starts, without the steps of a voxel grid.
SurfacePoints first_surface(const MendingJob& job) {
  const double spacing = spacing_of(job, 0);
  SurfacePoints surface =
      spacing > kThinned * job.spacing ? sampled(job, job.start, job.spacing, 0) : job.start;
  for (int i = 0; i < kFirstSmoothings && surface.size() >= kLeastMendedPoints; ++i)
    smooth(surface, spacing, job.settings.threads);
  return surface;
}

/// One round: costs of offsets, the offsets, the surface anew.
/// @param bound  whether outlines stay where the photographs have them
void mend_round(const MendingJob& job, std::size_t round, bool bound, SurfacePoints& surface) {
  const int threads = job.settings.threads;
  const int level = kMendingLevels[round];
  const double pixel = pixel_of(job, round), spacing = spacing_of(job, round);
  ConsistencySettings matching;
  matching.spacing = pixel;
  matching.tolerance = 4 * spacing;
  matching.threads = threads;
  const OffsetRange range = round == 0 ? OffsetRange{-8 * pixel, 0.5 * pixel, 21}
                                       : OffsetRange{-2 * pixel, 0.25 * pixel, 17};
  const auto costs = photo_costs(job.levels[std::size_t(level)], surface, spacing, range, matching);
  const SurfaceNeighbours near = find_neighbours(surface, kNearOffsets, kReach * spacing, threads);
  OffsetSettings choosing;
  choosing.threads = threads;
  std::vector<OffsetLimits> limits;
  if (bound) limits = outline_limits(job.outlines, surface, spacing, threads);
  move_along_normals(surface, choose_offsets(costs, range, near, choosing, limits));
  smooth(surface, spacing, threads);
  surface = sampled(job, surface, spacing, round + 1);
}

}  // namespace

SurfacePoints mended(const MendingJob& job, bool bound, const std::function<void()>& next) {
  SurfacePoints surface = first_surface(job);
  for (std::size_t round = 0; round < kMendingLevels.size() && surface.size() >= kLeastMendedPoints;
       ++round) {
    next();
    mend_round(job, round, bound, surface);
  }
  return surface;
}

}  // namespace slf
