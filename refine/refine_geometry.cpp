#include "refine/refine_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <utility>

#include "capture/quantile.h"
#include "capture/resample.h"
#include "capture/spacing.h"
#include "refine/held_out.h"
#include "refine/offset_field.h"
#include "refine/photo_consistency.h"
#include "refine/regions.h"
#include "refine/shine_through.h"
#include "refine/silhouettes.h"

namespace slf {
namespace {

// All measured on middlebury_dino: docs/pictures/geometry.md.
constexpr std::size_t kLeastCameras = 8, kLeastPoints = 1000, kMostPoints = 2'000'000;
constexpr std::size_t kNear = 24;                  // points of a plane
constexpr double kReach = 1.5;                     // spacings: of a neighbour's influence
constexpr std::size_t kNearOffsets = 12;           // points whose offsets agree
constexpr int kFirstSmoothings = 2;                // the steps of a voxel grid are no surface
constexpr std::array<int, 4> kLevels{2, 2, 1, 1};  // of the photographs, a round each
constexpr double kRegion = 8;        // spacings: side of the cubes that are kept or not
constexpr double kUnseenMove = 2;    // lattice steps: moved farther, a point must be seen
constexpr double kLeastGain = 0.05;  // of the squared error, for kAuto
constexpr double kTorn = 0.006;      // of the squared error, at most: what is uncovered
constexpr double kSlanted = 1.4;     // lattice steps: between points of a slanted surface
constexpr double kExact = 0.25;      // pixels of half-size photographs: a cloud that kAuto leaves

struct Job {
  const Capture& capture;
  std::span<const int> cameras;
  const RefineSettings& settings;
  CameraParts parts;
  SurfacePoints start;
  double spacing = 0;  ///< of the capture's points
  double pixel = 0;    ///< of the finest level used, world units at the object
  std::vector<std::vector<PhotoView>> levels;
  std::vector<Silhouette> outlines;  ///< of the photographs that are matched
  std::vector<Silhouette> judged;    ///< of those held out
};

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

/// Photographs down to the size at which a pixel is about half a point spacing, and coarser.
Result<Done, InputError> load_levels(Job& job) {
  SLF_TRY(std::vector<PhotoView> views,
          load_views(job.capture, job.parts.matched, job.settings.threads));
  job.pixel = middle_pixel(job.start, views);
  const auto halve = [&views] {
    for (PhotoView& view : views) view = half(view);
  };
  for (; job.pixel > 0 && job.pixel < 0.4 * job.spacing; job.pixel *= 2) halve();
  const auto silhouettes = [&job](std::span<const int> cameras) {
    return load_silhouettes(job.capture, cameras, job.start, job.spacing, job.settings.threads);
  };
  SLF_TRY(job.outlines, silhouettes(job.parts.matched));
  SLF_TRY(job.judged, silhouettes(job.parts.held_out));
  const int coarsest = *std::max_element(kLevels.begin(), kLevels.end());
  for (int level = 0; level <= coarsest; ++level) {
    job.levels.push_back(views);
    halve();
  }
  return Done{};
}

/// Positions on the surface that their neighbours make, and its normals.
void smooth(SurfacePoints& surface, double spacing, int threads) {
  const Neighbours near = find_neighbours(surface, kNear, kReach * spacing, threads);
  surface.normals = plane_normals(surface, near, threads);
  move_along_normals(surface, distance_to_neighbours(surface, near, threads));
}

/// The lattice of the grid that follows, where that is not much finer than the points.
Lattice lattice_of(const SurfacePoints& surface, const Job& job, bool& of_grid) {
  Lattice lattice;
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
  const RefineSettings& s = job.settings;
  const double nodes = std::pow(2.0, s.grid_bits);
  const double step = s.voxel_size > 0 ? s.voxel_size : extent / (nodes - 1);
  of_grid = step >= 0.7 * job.spacing;
  lattice.step = of_grid ? step : 0.9 * job.spacing;
  if (s.voxel_size == 0 && of_grid)
    lattice.size = {std::int64_t(nodes), std::int64_t(nodes), std::int64_t(nodes)};
  return lattice;
}

/// One round: costs of offsets, the offsets, the surface anew.
/// @param bound  whether outlines stay where the photographs have them
void mend_round(const Job& job, std::size_t round, bool bound, SurfacePoints& surface) {
  const int threads = job.settings.threads;
  const int level = kLevels[round];
  const double pixel = job.pixel * std::pow(2.0, level);
  const OffsetRange range = round == 0 ? OffsetRange{-8 * pixel, 0.5 * pixel, 21}
                                       : OffsetRange{-2 * pixel, 0.25 * pixel, 17};
  ConsistencySettings matching;
  matching.spacing = pixel;
  matching.tolerance = 4 * job.spacing;
  matching.threads = threads;
  const auto costs =
      photo_costs(job.levels[std::size_t(level)], surface, job.spacing, range, matching);
  const Neighbours near = find_neighbours(surface, kNearOffsets, kReach * job.spacing, threads);
  OffsetSettings choosing;
  choosing.threads = threads;
  std::vector<OffsetLimits> limits;
  if (bound) limits = outline_limits(job.outlines, surface, job.spacing, threads);
  move_along_normals(surface, choose_offsets(costs, range, near, choosing, limits));
  smooth(surface, job.spacing, threads);
  bool of_grid = false;
  ResampleSettings sampling;
  sampling.threads = threads;
  Lattice lattice = lattice_of(surface, job, of_grid);
  lattice.size = {};
  surface = resample(surface, lattice, sampling);
}

double decibels(double mean_square) {
  return 10 * std::log10(255 * 255 / std::max(mean_square, 1e-9));
}

/// How far points are from where they come from, and what became of those.
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
  report.points_before = before.size();
  report.points_after = after.size();
  report.removed = before.size() - std::size_t(std::count(used.begin(), used.end(), 1));
  report.moved = moves.size();
  if (moves.empty()) return;
  report.max_move = *std::max_element(moves.begin(), moves.end());
  report.median_move = median(std::move(moves));
}

/// A surface that may take the place of the capture's.
struct Candidate {
  SurfacePoints points;
  double error = std::numeric_limits<double>::infinity();  ///< mean square of held-out photographs,
                                                           ///< what is uncovered counted
  double uncovered = 0;                                    ///< its share in that
  std::size_t kept_back = 0;
  Lattice lattice;
  bool of_grid = false;
};

/// Mended where that helps, on the lattice of the grid; without points where nothing is left.
Result<Candidate, InputError> judge(const Job& job, const HeldOutErrors& before,
                                    const SurfacePoints& mended) {
  const int threads = job.settings.threads;
  const auto errors = [&](const SurfacePoints& points) {
    return held_out_errors(job.capture, job.cameras, points, job.spacing, threads);
  };
  Candidate candidate;
  candidate.lattice = lattice_of(mended, job, candidate.of_grid);
  const double step = candidate.lattice.step;
  const double apart = step > job.spacing ? kSlanted * step : job.spacing;
  const auto uncovered = [&](const SurfacePoints& points) {
    return uncovered_errors(job.judged, job.start, points, apart, threads);
  };
  SLF_TRY(const HeldOutErrors after, errors(mended));
  auto keep =
      worse_after(job.start, before, mended, after, uncovered(mended), kRegion * job.spacing);
  const auto torn = shines_through(job.capture, job.cameras, job.start,
                                   with_kept(job.start, mended, keep), job.spacing, threads);
  for (std::size_t p = 0; p < keep.size(); ++p) keep[p] |= torn[p];
  candidate.kept_back = std::size_t(std::count(keep.begin(), keep.end(), 1));
  const SurfacePoints both = with_kept(job.start, mended, keep);
  candidate.lattice = lattice_of(both, job, candidate.of_grid);
  ResampleSettings sampling;
  sampling.on_lattice = candidate.of_grid;
  sampling.threads = threads;
  const SurfacePoints final = resample(both, candidate.lattice, sampling);
  if (final.size() < kLeastPoints) return candidate;
  SLF_TRY(const HeldOutErrors last, errors(final));
  const HeldOutErrors lost = uncovered(final);
  candidate.error = mean_of(last, lost);
  candidate.uncovered = 1 - last.squares_sum() / (last.squares_sum() + lost.squares_sum());
  candidate.points =
      without_unsupported(job.start, final, last.seen, kUnseenMove * candidate.lattice.step);
  return candidate;
}

/// Median distance, in pixels of half-size photographs, between some points and where photographs
/// agree best along their normals, 4 pixels at most; of points where they agree well somewhere and
/// not everywhere.
double typical_miss(const Job& job) {
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
    if (*least<kAgree&& * most - *least> kTells)
      misses.push_back(std::abs(double(range.at(std::size_t(least - row)))) / pixel);
  }
  if (misses.size() < kLeastPoints / 10) return 0;  // nothing to go by
  return median(std::move(misses));
}

/// All rounds.
SurfacePoints mended(const Job& job, bool bound, const std::function<void()>& next) {
  SurfacePoints surface = job.start;
  for (int i = 0; i < kFirstSmoothings; ++i) smooth(surface, job.spacing, job.settings.threads);
  for (std::size_t round = 0; round < kLevels.size() && surface.size() >= kLeastPoints; ++round) {
    next();
    mend_round(job, round, bound, surface);
  }
  return surface;
}

/// Free, or where that tears the surface bound to the outlines of the photographs: a glossy or
/// translucent object looks alike from all sides where its mirror images are, far inside. Without
/// points where both tear it.
Result<Candidate, InputError> mended_whole(const Job& job, const HeldOutErrors& before,
                                           const Progress& progress) {
  double done = 0;
  const auto next = [&] {
    if (progress) progress("refine", done++ / double(2 * kLevels.size() + 1));
  };
  for (const bool bound : {false, true}) {
    const SurfacePoints surface = mended(job, bound, next);
    if (surface.size() < kLeastPoints) continue;  // nothing like a surface
    SLF_TRY(Candidate candidate, judge(job, before, surface));
    if (candidate.uncovered <= kTorn) return candidate;
  }
  return Candidate{};
}

Result<Done, InputError> mend(Job& job, RefinedCloud& out, const Progress& progress) {
  SLF_CHECK(load_levels(job));
  if (!(job.pixel > 0)) return Done{};
  const bool automatic = job.settings.mode == RefineGeometry::kAuto;
  if (automatic && typical_miss(job) <= kExact) return Done{};
  SLF_TRY(const HeldOutErrors before,
          held_out_errors(job.capture, job.cameras, job.start, job.spacing, job.settings.threads));
  SLF_TRY(Candidate best, mended_whole(job, before, progress));
  RefineReport& report = out.report;
  report.kept_back = best.kept_back;
  report.held_out_before = report.held_out_after = decibels(before.mean());
  if (!(best.error < (1 - (automatic ? kLeastGain : 0)) * before.mean())) return Done{};
  report.outcome = RefineReport::kMended;
  report.held_out_after = decibels(best.error);
  count_moves(job.start, best.points, best.lattice.step, report);
  out.voxel_size = best.of_grid ? best.lattice.step : 0;
  out.cloud.positions = std::move(best.points.positions);
  out.cloud.normals = std::move(best.points.normals);
  return Done{};
}

/// Why nothing is tried; kNoGain: it is.
RefineReport::Outcome obstacle(const Capture& capture, std::span<const int> cameras,
                               RefineGeometry mode) {
  if (mode == RefineGeometry::kOff) return RefineReport::kNotAsked;
  if (cameras.size() < kLeastCameras) return RefineReport::kTooFewCameras;
  if (capture.cloud.positions.size() < kLeastPoints) return RefineReport::kTooFewPoints;
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
  Job job{capture, cameras, settings, split_for_mending(cameras), {}, 0, 0, {}, {}, {}};
  job.spacing = typical_spacing(capture.cloud.positions);
  if (!(job.spacing > 0)) return out;
  job.start = surface_of(capture, settings.threads);
  SLF_CHECK(mend(job, out, progress));
  if (progress) progress("refine", 1);
  return out;
}

}  // namespace slf
