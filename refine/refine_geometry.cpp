#include "refine/refine_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "capture/spacing.h"
#include "refine/held_out.h"
#include "refine/offset_field.h"
#include "refine/photo_consistency.h"
#include "refine/regions.h"
#include "capture/resample.h"
#include "refine/shine_through.h"

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
double pixel_on_surface(const SurfacePoints& points, std::span<const PhotoView> views) {
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
  if (sizes.empty()) return 0;
  const auto middle = sizes.begin() + std::ptrdiff_t(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

/// Photographs down to the size at which a pixel is about half a point spacing, and coarser.
Result<Done, InputError> load_levels(Job& job) {
  SLF_TRY(std::vector<PhotoView> views,
          load_views(job.capture, job.parts.matched, job.settings.threads));
  job.pixel = pixel_on_surface(job.start, views);
  const auto halve = [&views] {
    for (PhotoView& view : views) view = half(view);
  };
  for (; job.pixel > 0 && job.pixel < 0.4 * job.spacing; job.pixel *= 2) halve();
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
void mend_round(Job& job, std::size_t round, SurfacePoints& surface) {
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
  move_along_normals(surface, choose_offsets(costs, range, near, choosing));
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
  const auto middle = moves.begin() + std::ptrdiff_t(moves.size() / 2);
  std::nth_element(moves.begin(), middle, moves.end());
  report.median_move = *middle;
  report.max_move = *std::max_element(moves.begin(), moves.end());
}

/// Mended where that helps, on the lattice of the grid; empty where all in all it does not.
Result<SurfacePoints, InputError> accept(Job& job, const SurfacePoints& mended, RefinedCloud& out) {
  const int threads = job.settings.threads;
  const auto errors = [&](const SurfacePoints& points) {
    return held_out_errors(job.capture, job.cameras, points, job.spacing, threads);
  };
  SLF_TRY(const HeldOutErrors before, errors(job.start));
  SLF_TRY(const HeldOutErrors after, errors(mended));
  RefineReport& report = out.report;
  report.held_out_before = report.held_out_after = decibels(before.mean());
  auto keep = worse_after(job.start, before, mended, after, kRegion * job.spacing);
  const auto torn = shines_through(job.capture, job.cameras, job.start,
                                   with_kept(job.start, mended, keep), job.spacing, threads);
  for (std::size_t p = 0; p < keep.size(); ++p) keep[p] |= torn[p];
  report.kept_back = std::size_t(std::count(keep.begin(), keep.end(), 1));
  const SurfacePoints both = with_kept(job.start, mended, keep);
  bool of_grid = false;
  const Lattice lattice = lattice_of(both, job, of_grid);
  ResampleSettings sampling;
  sampling.on_lattice = of_grid;
  sampling.threads = threads;
  SurfacePoints final = resample(both, lattice, sampling);
  if (final.size() < kLeastPoints) return SurfacePoints{};
  SLF_TRY(const HeldOutErrors last, errors(final));
  const double least = job.settings.mode == RefineGeometry::kAuto ? kLeastGain : 0;
  if (!(last.mean() < (1 - least) * before.mean())) return SurfacePoints{};
  report.held_out_after = decibels(last.mean());
  final = without_unsupported(job.start, final, last.seen, kUnseenMove * lattice.step);
  out.voxel_size = of_grid ? lattice.step : 0;
  count_moves(job.start, final, lattice.step, report);
  return final;
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
  const auto middle = misses.begin() + std::ptrdiff_t(misses.size() / 2);
  std::nth_element(misses.begin(), middle, misses.end());
  return *middle;
}

Result<Done, InputError> mend(Job& job, RefinedCloud& out, const Progress& progress) {
  SLF_CHECK(load_levels(job));
  if (!(job.pixel > 0)) return Done{};
  if (job.settings.mode == RefineGeometry::kAuto && typical_miss(job) <= kExact) return Done{};
  SurfacePoints mended = job.start;
  for (int i = 0; i < kFirstSmoothings; ++i) smooth(mended, job.spacing, job.settings.threads);
  for (std::size_t round = 0; round < kLevels.size(); ++round) {
    if (progress) progress("refine", double(round) / double(kLevels.size() + 1));
    mend_round(job, round, mended);
    if (mended.size() < kLeastPoints) return Done{};  // nothing like a surface
  }
  job.levels.clear();
  if (progress) progress("refine", double(kLevels.size()) / double(kLevels.size() + 1));
  SLF_TRY(SurfacePoints accepted, accept(job, mended, out));
  if (accepted.size() == 0) return Done{};
  out.report.outcome = RefineReport::kMended;
  out.cloud.positions = std::move(accepted.positions);
  out.cloud.normals = std::move(accepted.normals);
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
  Job job{capture, cameras, settings, split_for_mending(cameras), {}, 0, 0, {}};
  job.spacing = typical_spacing(capture.cloud.positions);
  if (!(job.spacing > 0)) return out;
  job.start = surface_of(capture, settings.threads);
  SLF_CHECK(mend(job, out, progress));
  if (progress) progress("refine", 1);
  return out;
}

}  // namespace slf
