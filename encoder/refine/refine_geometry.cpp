// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/refine_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "capture/quantile.h"
#include "capture/spacing.h"
#include "encoder/refine/judge_mended.h"
#include "encoder/refine/mend_rounds.h"
#include "encoder/refine/photo_consistency.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/decisions/019.
constexpr std::size_t kLeastCameras = 8, kMostPoints = 2'000'000;
constexpr double kLeastGain = 0.15;  // of the squared error, for kAuto: less may be the smoothing
// Pixels of half-size photographs: a cloud that kAuto leaves (the can: 0), one that is wrong for
// sure (the dino: 1.5; an exact can in photographs of 48 pixels: 0.5).
constexpr double kExact = 0.25, kWrong = 1;
// What a free surface leaves of the hull's squared error: 0.33 of the dino's, with hollows; 0.8 of
// a can's and a die's, where outlines hold better or as well. docs/decisions/063
constexpr double kHollow = 0.5;

SurfacePoints surface_of(const Capture& capture, int threads) {
  SurfacePoints surface{capture.cloud.positions, capture.cloud.normals, {}};
  if (surface.normals.empty()) {
    std::vector<Vec3> viewpoints;
    for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
    surface.normals = estimate_normals(capture.cloud, viewpoints, 16, threads);
  }
  surface.source.resize(surface.size());
  for (std::size_t p = 0; p < surface.size(); ++p) surface.source[p] = std::uint32_t(p);
  return surface;
}

double decibels(double mean_square) {
  return 10 * std::log10(255 * 255 / std::max(mean_square, 1e-9));
}

/// How far points are from where they come from, and what became of those.
/// @param report  its points_before are the capture's, of which `before` may be a part
void count_moves(const SurfacePoints& before, const SurfacePoints& after, double step,
                 RefineReport& report) {
  std::vector<std::uint8_t> used(before.size(), 0);
  std::vector<double> moves;
  for (std::size_t p = 0; p < after.size(); ++p) {
    const std::uint32_t from = after.source[p];
    report.added += used[from];
    used[from] = 1;
    const Float3 apart = minus(after.positions[p], before.positions[from]);
    const double move = std::abs(double(dot(apart, before.normals[from]))) / step;
    if (move > 0.5) moves.push_back(move);
  }
  report.points_after = after.size();
  report.removed = report.points_before - std::size_t(std::count(used.begin(), used.end(), 1));
  report.moved = moves.size();
  if (moves.empty()) return;
  report.max_move = *std::max_element(moves.begin(), moves.end());
  report.median_move = median(std::move(moves));
}

/// Median distance, in pixels of half-size photographs, between some points and where photographs
/// agree best along their normals, 4 pixels at most; of points where they agree well somewhere and
/// not everywhere.
double typical_miss(const MendingJob& job) {
  constexpr int kLevel = 1;
  constexpr float kAgree = 0.5f, kTells = 0.2f;
  constexpr std::size_t kLooked = 3000;
  const double pixel = job.pixel * std::pow(2.0, kLevel);
  const OffsetRange range{-4 * pixel, 0.5 * pixel, 17};
  ConsistencySettings matching;
  matching.spacing = pixel;
  matching.tolerance = 4 * job.spacing;
  matching.threads = job.settings.threads;
  const auto costs = photo_costs(job.levels[kLevel], job.start, job.spacing, range, matching,
                                 std::max<std::size_t>(job.start.size() / kLooked, 1));
  std::vector<double> misses;
  for (auto row = costs.begin(); row != costs.end(); row += std::ptrdiff_t(range.count)) {
    const auto [least, most] = std::minmax_element(row, row + std::ptrdiff_t(range.count));
    const bool agrees = *least<kAgree, tells = *most - *least> kTells;
    if (agrees && tells)
      misses.push_back(std::abs(double(range.at(std::size_t(least - row)))) / pixel);
  }
  if (misses.size() < kLeastMendedPoints / 10) return 0;  // nothing to go by
  return median(std::move(misses));
}

/// Surfaces by how outlines hold them; without points where they are not there yet.
using Surfaces = std::array<SurfacePoints, 2>;

Result<Done, InputError> mend_as(MendingJob& job, Outlines outlines,
                                 const std::function<void()>& next, Surfaces& surfaces) {
  if (outlines == Outlines::kBound) {
    SLF_TRY(job.outlines, silhouettes_of(job, job.parts.matched));
  }
  surfaces[std::size_t(outlines)] = mended(job, outlines, next);
  return Done{};
}

/// Whether a surface that outlines hold predicts photographs better than a free one. Where that
/// gains much on the hull, the object has hollows that no outline shows, and none is made.
/// @param before  mean square of held-out photographs, by job.start
Result<bool, InputError> bound_is_better(MendingJob& job, double before,
                                         const std::function<void()>& next, Surfaces& surfaces) {
  const auto& [free, bound] = surfaces;
  SLF_CHECK(mend_as(job, Outlines::kFree, next, surfaces));
  double free_error = std::numeric_limits<double>::infinity();
  if (free.size() >= kLeastMendedPoints) {
    SLF_TRY(free_error, quick_error(job, free));
  }
  if (free_error < kHollow * before) return false;
  SLF_CHECK(mend_as(job, Outlines::kBound, next, surfaces));
  if (bound.size() < kLeastMendedPoints) return false;
  SLF_TRY(const double bound_error, quick_error(job, bound));
  return bound_error < free_error;
}

/// Free, or bound to the outlines of the photographs: a glossy or translucent object looks alike
/// from all sides where its mirror images are, far inside. Where outlines tell a hull both are
/// tried, and the better one is taken; elsewhere it is bound where free tears the surface. Without
/// points where both tear it.
Result<Candidate, InputError> mended_whole(MendingJob& job, const HeldOutErrors& before,
                                           const Progress& progress) {
  double done = 0;
  const auto next = [&] {
    if (progress) progress("refine", done++ / double(2 * kMendingLevels.size() + 1));
  };
  Surfaces surfaces;
  std::array order{Outlines::kFree, Outlines::kBound};
  if (!job.hull.empty()) {
    SLF_TRY(const bool better, bound_is_better(job, before.mean(), next, surfaces));
    if (better) std::swap(order[0], order[1]);
  }
  for (const Outlines outlines : order) {
    const SurfacePoints& surface = surfaces[std::size_t(outlines)];
    if (surface.size() == 0) SLF_CHECK(mend_as(job, outlines, next, surfaces));
    if (surface.size() < kLeastMendedPoints) continue;  // nothing like a surface
    SLF_TRY(Candidate candidate, judge_mended(job, before, polished(job, surface, outlines)));
    if (!candidate.torn && candidate.points.size() > 0) return candidate;
  }
  return Candidate{};
}

Result<Done, InputError> mend(MendingJob& job, RefinedCloud& out, const Progress& progress) {
  SLF_CHECK(load_photographs(job, *std::max_element(kMendingLevels.begin(), kMendingLevels.end())));
  if (!(job.pixel > 0)) return Done{};
  const bool automatic = job.settings.mode == RefineGeometry::kAuto;
  const double miss = automatic ? typical_miss(job) : 0;
  out.report.exact = automatic && miss <= kExact;
  if (out.report.exact) return Done{};
  if (automatic && job.settings.pays) {
    SLF_TRY(const bool pays, job.settings.pays());
    if (!pays) {
      out.report.outcome = RefineReport::kOutdone;
      return Done{};
    }
  }
  const int finest = *std::min_element(kMendingLevels.begin(), kMendingLevels.end());
  if (job.settings.free_grid) {
    thin_start(job, finest);
  } else {
    out.report.too_dense_for_grid = miss >= kWrong && is_dense(job, finest);
  }
  SLF_TRY(job.judged, silhouettes_of(job, job.parts.held_out));
  SLF_TRY(const HeldOutErrors given, sampled_errors(job, job.start));
  job.given_error = given.mean();
  SLF_TRY(const HeldOutErrors before, carve_start(job, given));
  SLF_TRY(Candidate best, mended_whole(job, before, progress));
  RefineReport& report = out.report;
  report.kept_back = best.kept_back;
  report.held_out_before = report.held_out_after = decibels(job.given_error);
  if (!(best.error < (1 - (automatic ? kLeastGain : 0)) * job.given_error)) return Done{};
  report.outcome = RefineReport::kMended;
  report.held_out_after = decibels(best.error);
  count_moves(job.start, best.points, best.on.lattice.step, report);
  out.voxel_size = best.on.of_grid ? best.on.lattice.step : 0;
  out.cloud.positions = std::move(best.points.positions);
  out.cloud.normals = std::move(best.points.normals);
  return Done{};
}

/// Why nothing is tried; kNoGain: it is.
RefineReport::Outcome obstacle(const Capture& capture, std::span<const int> cameras,
                               RefineGeometry mode) {
  if (mode == RefineGeometry::kOff) return RefineReport::kNotAsked;
  if (cameras.size() < kLeastCameras) return RefineReport::kTooFewCameras;
  if (capture.cloud.positions.size() < kLeastMendedPoints) return RefineReport::kTooFewPoints;
  if (capture.cloud.positions.size() > kMostPoints) return RefineReport::kTooManyPoints;
  return RefineReport::kNoGain;
}

}  // namespace

Result<RefinedCloud, InputError> refine_geometry(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const RefineSettings& settings,
                                                 const Progress& progress) {
  RefinedCloud out;
  out.report.points_before = out.report.points_after = capture.cloud.positions.size();
  out.report.outcome = obstacle(capture, cameras, settings.mode);
  if (out.report.outcome != RefineReport::kNoGain) return out;
  MendingJob job{capture, cameras, settings, split_for_mending(cameras), {}, {}, 0, 0, 0, {},
                 {},      {},      {}};
  job.captured_spacing = job.spacing = typical_spacing(capture.cloud.positions);
  if (!(job.spacing > 0)) return out;
  job.start = surface_of(capture, settings.threads);
  SLF_CHECK(mend(job, out, progress));
  if (progress) progress("refine", 1);
  return out;
}

}  // namespace slf
