// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/judge_mended.h"

#include <algorithm>
#include <numeric>

#include "encoder/refine/regions.h"
#include "encoder/refine/shine_through.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/decisions/019.
constexpr double kRegion = 8;      // spacings: side of the cubes that are kept or not
constexpr double kUnseenMove = 2;  // lattice steps: moved farther, a point must be seen
constexpr double kInHull = 0.5;    // pixels: so near to an outline a point is inside
// Grey levels that an uncovered pixel of the object counts: before some background it would.
constexpr std::uint8_t kAnyBackground = 64;
constexpr double kSlanted = 1.4;  // lattice steps: between points of a slanted surface
// At most uncovered: of the squared error that remains; of what it falls by, where points were
// thinned, as the better a surface is mended, the less remains.
constexpr double kTorn = 0.006, kTornOfGain = 0.025;

/// What `points` on a lattice of `step` uncover.
/// @param least  of uncovered_errors
HeldOutErrors uncovered_by(const MendingJob& job, const SurfacePoints& before, double spacing,
                           const SurfacePoints& points, double step, std::uint8_t least = 0) {
  const double apart = step > spacing || job.thinned() ? kSlanted * step : spacing;
  return uncovered_errors(job.judged, before, points, std::max(apart, spacing),
                          job.settings.threads, least);
}

/// The same at the scale of the capture's points, weighted as the points of `final` are: discs as
/// wide as thinned points need would cover what an outline has lost.
HeldOutErrors uncovered_in_all(const MendingJob& job, const SurfacePoints& both,
                               const SurfacePoints& final, double step) {
  if (!job.thinned()) return uncovered_by(job, job.start, job.spacing, final, step);
  const Lattice fine = lattice_of_captured(both, job);
  const SurfacePoints dense =
      resample(both, fine, sampling_of(job.spacing, fine, job.settings.threads));
  HeldOutErrors lost = uncovered_by(job, job.captured, job.captured_spacing, dense, fine.step);
  const auto weight = float(double(final.size()) / double(job.captured.size()));
  for (float& x : lost.squares) x *= weight;
  for (float& x : lost.views) x *= weight;
  return lost;
}

}  // namespace

Result<HeldOutErrors, InputError> carve_start(MendingJob& job, const HeldOutErrors& given) {
  SLF_CHECK(find_hull(job));
  if (job.hull.empty()) return given;
  SurfacePoints carved = job.start;
  carve_surface(job, kInHull, carved);
  if (carved.size() < kLeastMendedPoints) {  // outlines of something else
    job.hull.clear();
    return given;
  }
  SLF_TRY(const HeldOutErrors after, sampled_errors(job, carved));
  const HeldOutErrors lost = uncovered_by(job, job.start, job.spacing, carved, job.spacing);
  const auto keep = worse_after(job.start, given, carved, after, lost, kRegion * job.spacing);
  job.start = with_kept(job.start, carved, keep);
  std::iota(job.start.source.begin(), job.start.source.end(), 0u);
  return sampled_errors(job, job.start);
}

Result<double, InputError> quick_error(const MendingJob& job, const SurfacePoints& mended) {
  SLF_TRY(const HeldOutErrors errors, sampled_errors(job, mended));
  return mean_of(errors, uncovered_by(job, job.start, job.spacing, mended,
                                      lattice_of(mended, job).lattice.step, kAnyBackground));
}

Result<Candidate, InputError> judge_mended(const MendingJob& job, const HeldOutErrors& before,
                                           const SurfacePoints& mended) {
  const int threads = job.settings.threads;
  Candidate candidate;
  SLF_TRY(const HeldOutErrors after, sampled_errors(job, mended));
  const HeldOutErrors lost_after =
      uncovered_by(job, job.start, job.spacing, mended, lattice_of(mended, job).lattice.step);
  auto keep = worse_after(job.start, before, mended, after, lost_after, kRegion * job.spacing);
  const auto torn = shines_through(job.capture, job.cameras, job.start,
                                   with_kept(job.start, mended, keep), job.spacing, threads);
  for (std::size_t p = 0; p < keep.size(); ++p) keep[p] |= torn[p];
  candidate.kept_back = std::size_t(std::count(keep.begin(), keep.end(), 1));
  const SurfacePoints both = with_kept(job.start, mended, keep);
  candidate.on = final_lattice_of(both, job);
  const Lattice& lattice = candidate.on.lattice;
  ResampleSettings sampling = sampling_of(job.thinned() ? job.spacing : 0, lattice, threads);
  sampling.on_lattice = candidate.on.of_grid;
  const SurfacePoints final = resample(both, lattice, sampling);
  if (final.size() < kLeastMendedPoints) return candidate;
  SLF_TRY(const HeldOutErrors last,
          held_out_errors(job.capture, job.cameras, final, job.spacing, threads));
  const HeldOutErrors lost = uncovered_in_all(job, both, final, lattice.step);
  candidate.error = mean_of(last, lost);
  const double share = 1 - last.squares_sum() / (last.squares_sum() + lost.squares_sum());
  const double gain = job.given_error - candidate.error;
  candidate.torn = job.thinned() ? share * candidate.error > kTornOfGain * gain : share > kTorn;
  candidate.points = without_unsupported(job.start, final, last.seen, kUnseenMove * lattice.step);
  return candidate;
}

}  // namespace slf
