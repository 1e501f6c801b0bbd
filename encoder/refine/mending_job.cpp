// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/mending_job.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "capture/quantile.h"
#include "capture/spacing.h"
#include "encoder/refine/carve.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/decisions/019.
constexpr double kPatchesApart = 1;  // of the finest photographs matched, between points: nearer
                                     // ones have the same patch
constexpr double kDenser = 1.2;      // times farther apart: worth it
constexpr double kPixelsPerMended = 0.75;  // of the photographs: a free grid's voxel
constexpr double kFarthestCarved = 16;     // spacings
constexpr double kLatticeStep = 0.7;       // spacings: a lattice as fine as this has its points
constexpr double kFinestStep = 0.3;        // spacings of points that were thinned: time and memory
                                           // grow with the cube
constexpr double kStepOfSpacing = 0.9;     // a lattice on which points are as far apart as before

/// Median size of a photograph's pixel on the surface that it faces; 0: nothing is in any picture.
double middle_pixel(const SurfacePoints& points, std::span<const PhotoView> views) {
  constexpr std::size_t kSamples = 1000;
  const std::size_t stride = std::max<std::size_t>(points.size() / kSamples, 1);
  std::vector<double> sizes;
  for (const PhotoView& view : views)
    for (std::size_t p = 0; p < points.size(); p += stride) {
      const Float3& at = points.positions[p];
      double z = 0;
      const auto image = view.camera->project({at[0], at[1], at[2]}, &z);
      if (image && (*image)[0] >= 0 && (*image)[0] < view.camera->width && (*image)[1] >= 0 &&
          (*image)[1] < view.camera->height)
        sizes.push_back(z / (std::max(view.camera->fx, view.camera->fy) * view.scale));
    }
  return median(std::move(sizes));
}

/// For points that lie `spacing` apart.
MendingLattice lattice_of(const SurfacePoints& surface, const RefineSettings& s, double spacing) {
  MendingLattice found;
  Lattice& lattice = found.lattice;
  Vec3 high{};
  double extent = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    double low = std::numeric_limits<double>::max();
    high[a] = std::numeric_limits<double>::lowest();
    for (const Float3& p : surface.positions) {
      low = std::min(low, double(p[a]));
      high[a] = std::max(high[a], double(p[a]));
    }
    lattice.origin[a] = low;
    extent = std::max(extent, high[a] - low);
  }
  const double nodes = std::pow(2.0, s.grid_bits);
  const double step = s.voxel_size > 0 ? s.voxel_size : extent / (nodes - 1);
  found.of_grid = step >= kLatticeStep * spacing;
  lattice.step = found.of_grid ? step : kStepOfSpacing * spacing;
  if (s.voxel_size == 0 && found.of_grid)
    lattice.size = {std::int64_t(nodes), std::int64_t(nodes), std::int64_t(nodes)};
  return found;
}

/// Between points that the photographs of `level` tell apart.
double apart_at(const MendingJob& job, int level) {
  return kPatchesApart * job.pixel * std::pow(2.0, level);
}

}  // namespace

Result<Done, InputError> load_photographs(MendingJob& job, int coarsest) {
  SLF_TRY(std::vector<PhotoView> views,
          load_views(job.capture, job.parts.matched, job.settings.threads));
  job.pixel = middle_pixel(job.start, views);
  const auto halve = [&views] {
    for (PhotoView& view : views) view = half(view);
  };
  for (; job.pixel > 0 && job.pixel < 0.4 * job.spacing; job.pixel *= 2) halve();
  for (int level = 0; level <= coarsest; ++level) {
    job.levels.push_back(views);
    halve();
  }
  return Done{};
}

Result<Done, InputError> find_hull(MendingJob& job) {
  SLF_TRY(job.hull,
          outlines_of(job.capture, job.parts.matched, job.settings.threads, Background::kCertain));
  if (!are_outlined(job.hull.size(), job.parts.matched.size())) job.hull.clear();
  return Done{};
}

void carve_surface(const MendingJob& job, double slack, SurfacePoints& surface) {
  carve(surface, job.hull, slack * job.pixel, kFarthestCarved * job.captured_spacing,
        job.settings.threads);
}

Result<std::vector<Silhouette>, InputError> silhouettes_of(const MendingJob& job,
                                                           std::span<const int> cameras) {
  return load_silhouettes(job.capture, cameras, job.start, job.spacing, job.settings.threads);
}

Result<HeldOutErrors, InputError> sampled_errors(const MendingJob& job,
                                                 const SurfacePoints& points) {
  const std::size_t every = (points.size() + kJudgedPoints - 1) / kJudgedPoints;
  return held_out_errors(job.capture, job.cameras, points, job.spacing, job.settings.threads,
                         every);
}

bool is_dense(const MendingJob& job, int level) {
  return apart_at(job, level) > kDenser * job.spacing;
}

void thin_start(MendingJob& job, int level) {
  if (!is_dense(job, level)) return;
  Lattice lattice = lattice_of(job.start, job).lattice;
  lattice.size = {};
  lattice.step = kStepOfSpacing * apart_at(job, level);
  ResampleSettings sampling;
  sampling.threads = job.settings.threads;
  SurfacePoints thin = resample(job.start, lattice, sampling);
  if (thin.size() < kLeastMendedPoints) return;
  job.captured = std::move(job.start);
  std::iota(thin.source.begin(), thin.source.end(), 0u);
  job.start = std::move(thin);
  job.spacing = typical_spacing(job.start.positions);
}

MendingLattice lattice_of(const SurfacePoints& surface, const MendingJob& job) {
  return lattice_of(surface, job.settings, job.spacing);
}

MendingLattice final_lattice_of(const SurfacePoints& surface, const MendingJob& job) {
  if (!job.thinned()) return lattice_of(surface, job);
  MendingLattice found = lattice_of(surface, job.settings, job.captured_spacing);
  found.of_grid = true;
  found.lattice.size = {};
  found.lattice.step =
      std::max({found.lattice.step, kPixelsPerMended * job.pixel, kFinestStep * job.spacing});
  return found;
}

Lattice lattice_of_captured(const SurfacePoints& surface, const MendingJob& job) {
  Lattice lattice = lattice_of(surface, job).lattice;
  lattice.size = {};
  lattice.step = std::max(kStepOfSpacing * job.captured_spacing, kFinestStep * job.spacing);
  return lattice;
}

ResampleSettings sampling_of(double spacing, const Lattice& lattice, int threads) {
  // As far between points as where the lattice is theirs.
  const double wider = std::max(1.0, kLatticeStep * spacing / lattice.step);
  ResampleSettings sampling;
  sampling.around = int(std::ceil(wider - 0.1));
  sampling.reach *= wider;
  sampling.support *= wider;
  sampling.rim *= wider;
  sampling.threads = threads;
  return sampling;
}

}  // namespace slf
