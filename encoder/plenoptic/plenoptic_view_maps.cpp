// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_view_maps.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/release.h"
#include "encoder/fit/fit_hierarchical.h"
#include "encoder/fit/fit_search.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kViewGrain = 4096;  // points
/// Points whose view maps are made at a time: they take as much again as components.
constexpr std::size_t kLookedAtOnce = std::size_t{1} << 17;
/// Large enough that memory that is given up is the system's again.
constexpr std::size_t kPieceBytes = std::size_t{64} << 20;
constexpr double kSamePlace = 1e-6;  // of a view's distance from the origin

/// Views that are fitted to, ascending.
std::vector<std::size_t> fitted_views(const PlenopticRecord& record, std::size_t views) {
  std::vector<std::size_t> fitted;
  for (std::size_t v = 0; v < views; ++v)
    if (std::find(record.hold_out.begin(), record.hold_out.end(), static_cast<int>(v)) ==
        record.hold_out.end())
      fitted.push_back(v);
  return fitted;
}

/// Observations are made when they are read: what makes them is a ninth of their size.
/// @param cloud, views  kept by reference
PointwiseObservations observations_of(const PlenopticCloud& cloud,
                                      const std::vector<std::size_t>& views) {
  return {
      cloud.num_points(), views.size(), [&](std::size_t point, SeenRoom& room) {
        room.direction.clear();
        room.colour.clear();
        room.camera.clear();
        const Vec3 at = cloud.grid.world(cloud.positions[point]);
        const std::size_t first = point * cloud.num_colours() + (cloud.own_colour ? 1 : 0);
        for (const std::size_t v : views) {
          const Vec3& view = cloud.view_positions[v];
          const Vec3 to{view[0] - at[0], view[1] - at[1], view[2] - at[2]};
          const std::uint8_t* colour = &cloud.colours[3 * (first + v)];
          // A view inside the point has no direction; up is as good as any.
          room.direction.push_back(to == Vec3{0, 0, 0} ? std::array{0.f, 1.f} : direction_of(to));
          room.colour.push_back({float(colour[0]), float(colour[1]), float(colour[2])});
          room.camera.push_back(static_cast<std::uint16_t>(v));
        }
        return room.seen();
      }};
}

/// All of them at once, in directions of settings: for the fit of the paper.
Observations kept(const PointwiseObservations& seen, const FitSettings& settings,
                  std::span<const Voxel> positions) {
  Observations all;
  SeenRoom room;
  all.first.push_back(0);
  for (std::size_t p = 0; p < seen.points(); ++p) {
    const SeenPoint point = seen.of(p, room);
    all.direction.insert(all.direction.end(), point.direction.begin(), point.direction.end());
    all.colour.insert(all.colour.end(), point.colour.begin(), point.colour.end());
    all.camera.insert(all.camera.end(), point.camera.begin(), point.camera.end());
    all.first.push_back(all.direction.size());
  }
  return in_local(std::move(all), settings.directions, positions, settings.normal_cell_log2,
                  settings.threads);
}

/// Every point has as many observations as any: there is nothing to fill in.
/// @param points  of settings, where they are of the hierarchical fit
Result<FittedRows, InputError> fit_rows(const PointwiseObservations& seen,
                                        std::span<const Voxel> positions,
                                        const MirrorPoints& points, const FitSettings& settings,
                                        const Progress& progress) {
  const std::size_t row = 3 * static_cast<std::size_t>(settings.basis.num_functions());
  if (settings.method == FitMethod::kHierarchical) {
    const bool reflected = settings.directions == Directions::kReflected;
    return fit_hierarchical(reflected ? seen.mirrored_at(points.normal) : seen, positions, points,
                            settings, kPieceBytes / (row * sizeof(float)) + 1, progress);
  }
  FittedRows rows(0, row);
  SLF_TRY(std::vector<float> coefficients,
          fit_view_maps(kept(seen, settings, positions), positions, settings, progress));
  rows.pieces().push_back(std::move(coefficients));
  return rows;
}

bool have_several_directions(const PlenopticCloud& cloud, const std::vector<std::size_t>& views) {
  if (views.size() < 2) return false;
  const Vec3& first = cloud.view_positions[views[0]];
  return std::any_of(views.begin(), views.end(), [&](std::size_t v) {
    double square = 0, size = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      square += std::pow(cloud.view_positions[v][k] - first[k], 2);
      size += std::pow(first[k], 2);
    }
    return square > kSamePlace * kSamePlace * std::max(size, 1e-12);
  });
}

/// Colours of the points from `first` on, of which there are maps, seen from every view.
void look(const ViewMaps& maps, const PlenopticRecord& record, std::size_t first, int threads,
          PlenopticCloud& cloud) {
  const std::size_t own = cloud.own_colour ? 1 : 0, row = 3 * cloud.num_colours();
  const auto set = [&](std::size_t point, std::size_t colour, std::size_t channel, float value) {
    cloud.colours[point * row + 3 * colour + channel] =
        static_cast<std::uint8_t>(std::lround(value));
  };
  parallel_ranges(maps.num_points(), kViewGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> some(end - begin);
    std::iota(some.begin(), some.end(), static_cast<std::uint32_t>(begin));
    std::vector<std::array<float, 3>> colours(some.size()), sum(some.size());
    for (std::size_t v = 0; v < cloud.views; ++v) {
      maps.radiances(record.view_positions[v], some, colours);
      for (std::size_t i = 0; i < some.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          sum[i][c] += colours[i][c];
          set(first + begin + i, own + v, c, colours[i][c]);
        }
    }
    for (std::size_t i = 0; own == 1 && i < some.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        set(first + begin + i, 0, c, sum[i][c] / float(cloud.views));
  });
}

}  // namespace

Result<LightField, InputError> fit_plenoptic(PlenopticCloud& cloud, const PlenopticRecord& record,
                                             EncoderSettings& settings, ChosenFit& chosen,
                                             const Progress& progress,
                                             const std::vector<int>& shift) {
  const auto views = fitted_views(record, cloud.views);
  if (!have_several_directions(cloud, views))
    return InputError{Errc::kInvalidInput,
                      "view maps need views in two places or more, which are not held out: planes "
                      "(--as planes) have no directions"};
  const FitSettings given = in_spacings(settings.fit, cloud.positions, cloud.grid.bits);
  const PointwiseObservations world = observations_of(cloud, views);
  MirrorPoints points;
  if (given.method == FitMethod::kHierarchical)
    points = mirror_points(cloud.positions, given.normal_cell_log2, given.threads);
  CaptureFit fit;
  SLF_TRY(fit.chosen, choose_fit(world, cloud.positions, points, given, settings.search, progress));
  settings.fit = fit.chosen.settings;
  trim_heap();
  SLF_TRY(FittedRows rows, fit_rows(world, cloud.positions, points, settings.fit, progress));
  points = {};
  release(cloud.colours);
  trim_heap();
  chosen = fit.chosen;
  return quantise_rows(cloud.grid, std::exchange(cloud.positions, {}), std::move(rows), fit,
                       settings, shift);
}

void look_from_views(const LightField& field, const PlenopticRecord& record, int threads,
                     PlenopticCloud& cloud) {
  const std::size_t points = cloud.num_points();
  cloud.colours.resize(points * 3 * cloud.num_colours());
  const LightFieldHeader& header = field.header;
  const auto normals =
      mirror_normals(header.directions, field.positions, header.normal_cell_log2, threads);
  for (std::size_t first = 0; first < points; first += kLookedAtOnce) {
    const std::size_t count = std::min(kLookedAtOnce, points - first);
    const auto rows = [&](const auto& of_all, std::size_t width) {
      const auto begin = of_all.begin() + static_cast<std::ptrdiff_t>(first * width);
      return std::vector(begin, begin + static_cast<std::ptrdiff_t>(count * width));
    };
    LightField some;
    some.header = header;
    some.positions = rows(field.positions, 1);
    some.components = rows(field.components, static_cast<std::size_t>(field.num_planes()));
    const ViewMaps maps(some, normals.empty() ? normals : rows(normals, 1), threads);
    look(maps, record, first, threads, cloud);
  }
}

}  // namespace slf
