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
constexpr double kStray = 2;              // pixels outside of an outline: blur, and photographs
                                          // that disagree
// Measured on middlebury_dino and `slf synth can --hull 4`: docs/decisions/063.
constexpr int kPolishings = 4;
constexpr double kPolishedCloser = 0.7;        // of the spacing, between points
constexpr std::size_t kMostPolished = 100000;  // points: time
constexpr double kLatticeOfSpacing = 0.9;

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

/// Where photographs of a level are looked at, and how far from the surface.
struct Search {
  int level = 0;
  double spacing = 0;  ///< of the points
  OffsetRange range;
};

Search near_surface(const MendingJob& job, int level, double spacing) {
  const double pixel = job.pixel * std::pow(2.0, level);
  return {level, spacing, {-2 * pixel, 0.25 * pixel, 17}};
}

Search search_of(const MendingJob& job, std::size_t round) {
  Search search = near_surface(job, kMendingLevels[round], spacing_of(job, round));
  const double pixel = pixel_of(job, round);
  if (round == 0) search.range = {-8 * pixel, 0.5 * pixel, 21};
  return search;
}

/// Costs of offsets, the offsets, and the surface that they make.
void mend_once(const MendingJob& job, const Search& search, Outlines outlines,
               SurfacePoints& surface) {
  const int threads = job.settings.threads;
  const double spacing = search.spacing;
  const double pixel = job.pixel * std::pow(2.0, search.level);
  ConsistencySettings matching;
  matching.spacing = pixel;
  matching.tolerance = 4 * spacing;
  matching.threads = threads;
  const auto costs =
      photo_costs(job.levels[std::size_t(search.level)], surface, spacing, search.range, matching);
  const SurfaceNeighbours near = find_neighbours(surface, kNearOffsets, kReach * spacing, threads);
  OffsetSettings choosing;
  choosing.threads = threads;
  std::vector<OffsetLimits> limits;
  if (outlines == Outlines::kBound)
    limits = outline_limits(job.outlines, surface, spacing, threads);
  move_along_normals(surface, choose_offsets(costs, search.range, near, choosing, limits));
  smooth(surface, spacing, threads);
  carve_surface(job, kStray, surface);
}

}  // namespace

SurfacePoints mended(const MendingJob& job, Outlines outlines, const std::function<void()>& next) {
  SurfacePoints surface = first_surface(job);
  for (std::size_t round = 0; round < kMendingLevels.size(); ++round) {
    next();
    if (surface.size() >= kLeastMendedPoints)
      mend_once(job, search_of(job, round), outlines, surface);
    if (surface.size() < kLeastMendedPoints) return {};
    surface = sampled(job, surface, spacing_of(job, round), round + 1);
  }
  return surface;
}

SurfacePoints polished(const MendingJob& job, const SurfacePoints& surface, Outlines outlines) {
  const double most = std::sqrt(double(surface.size()) / double(kMostPolished));
  const double spacing =
      std::max(job.captured_spacing, std::max(kPolishedCloser, most) * job.spacing);
  Lattice lattice = lattice_of(surface, job).lattice;
  lattice.size = {};
  lattice.step = kLatticeOfSpacing * spacing;
  SurfacePoints fine =
      resample(surface, lattice, sampling_of(job.spacing, lattice, job.settings.threads));
  for (int i = 0; i < kPolishings && fine.size() >= kLeastMendedPoints; ++i)
    mend_once(job, near_surface(job, 0, spacing), outlines, fine);
  return fine;
}

}  // namespace slf
