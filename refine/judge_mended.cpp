#include "refine/judge_mended.h"

#include <algorithm>

#include "refine/regions.h"
#include "refine/shine_through.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/pictures/geometry.md.
constexpr double kRegion = 8;      // spacings: side of the cubes that are kept or not
constexpr double kUnseenMove = 2;  // lattice steps: moved farther, a point must be seen
constexpr double kSlanted = 1.4;   // lattice steps: between points of a slanted surface

}  // namespace

Result<Candidate, InputError> judge_mended(const MendingJob& job, const HeldOutErrors& before,
                                           const SurfacePoints& mended) {
  const int threads = job.settings.threads;
  Candidate candidate;
  candidate.on = lattice_of(mended, job);
  const double step = candidate.on.lattice.step;
  const double apart = step > job.spacing ? kSlanted * step : job.spacing;
  const auto uncovered = [&](const SurfacePoints& points) {
    return uncovered_errors(job.judged, job.start, points, apart, threads);
  };
  SLF_TRY(const HeldOutErrors after, sampled_errors(job, mended));
  auto keep =
      worse_after(job.start, before, mended, after, uncovered(mended), kRegion * job.spacing);
  const auto torn = shines_through(job.capture, job.cameras, job.start,
                                   with_kept(job.start, mended, keep), job.spacing, threads);
  for (std::size_t p = 0; p < keep.size(); ++p) keep[p] |= torn[p];
  candidate.kept_back = std::size_t(std::count(keep.begin(), keep.end(), 1));
  const SurfacePoints both = with_kept(job.start, mended, keep);
  candidate.on = lattice_of(both, job);
  ResampleSettings sampling;
  sampling.on_lattice = candidate.on.of_grid;
  sampling.threads = threads;
  const SurfacePoints final = resample(both, candidate.on.lattice, sampling);
  if (final.size() < kLeastMendedPoints) return candidate;
  SLF_TRY(const HeldOutErrors last,
          held_out_errors(job.capture, job.cameras, final, job.spacing, threads));
  const HeldOutErrors lost = uncovered(final);
  candidate.error = mean_of(last, lost);
  candidate.uncovered = 1 - last.squares_sum() / (last.squares_sum() + lost.squares_sum());
  candidate.points =
      without_unsupported(job.start, final, last.seen, kUnseenMove * candidate.on.lattice.step);
  return candidate;
}

}  // namespace slf
