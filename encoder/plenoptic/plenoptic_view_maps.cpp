// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_view_maps.h"

#include <algorithm>
#include <cmath>

#include "slf/parallel.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kViewGrain = 4096;  // points
constexpr double kSamePlace = 1e-6;       // of a view's distance from the origin

/// Views that are fitted to, ascending.
std::vector<std::size_t> fitted_views(const PlenopticRecord& record, std::size_t views) {
  std::vector<std::size_t> fitted;
  for (std::size_t v = 0; v < views; ++v)
    if (std::find(record.hold_out.begin(), record.hold_out.end(), static_cast<int>(v)) ==
        record.hold_out.end())
      fitted.push_back(v);
  return fitted;
}

Observations observations_of(const PlenopticCloud& cloud, const std::vector<std::size_t>& views,
                             int threads) {
  const std::size_t points = cloud.num_points(), each = views.size();
  Observations seen;
  seen.first.resize(points + 1);
  for (std::size_t p = 0; p <= points; ++p) seen.first[p] = p * each;
  seen.direction.resize(points * each);
  seen.colour.resize(points * each);
  seen.camera.resize(points * each);
  const std::size_t row = 3 * cloud.num_colours(), own = cloud.own_colour ? 3 : 0;
  parallel_ranges(points, kViewGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const Vec3 at = cloud.grid.world(cloud.positions[p]);
      for (std::size_t i = 0; i < each; ++i) {
        const Vec3& view = cloud.view_positions[views[i]];
        const Vec3 to{view[0] - at[0], view[1] - at[1], view[2] - at[2]};
        const std::uint8_t* colour = &cloud.colours[p * row + own + 3 * views[i]];
        // A view inside the point has no direction; up is as good as any.
        seen.direction[p * each + i] =
            to == Vec3{0, 0, 0} ? std::array{0.f, 1.f} : direction_of(to);
        seen.colour[p * each + i] = {float(colour[0]), float(colour[1]), float(colour[2])};
        seen.camera[p * each + i] = static_cast<std::uint16_t>(views[i]);
      }
    }
  });
  return seen;
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

}  // namespace

Result<LightField, InputError> fit_plenoptic(const PlenopticCloud& cloud,
                                             const PlenopticRecord& record,
                                             EncoderSettings& settings, ChosenFit& chosen,
                                             const Progress& progress) {
  const auto views = fitted_views(record, cloud.views);
  if (!have_several_directions(cloud, views))
    return InputError{Errc::kInvalidInput,
                      "view maps need views in two places or more, which are not held out: planes "
                      "(--as planes) have no directions"};
  CaptureFit fit;
  {
    Observations world = observations_of(cloud, views, settings.threads);
    SLF_TRY(fit.chosen, choose_fit(world, cloud.positions,
                                   in_spacings(settings.fit, cloud.positions, cloud.grid.bits),
                                   settings.search, progress));
    settings.fit = fit.chosen.settings;
    const Observations seen = in_local(std::move(world), settings.fit.directions, cloud.positions,
                                       settings.fit.normal_cell_log2, settings.threads);
    SLF_TRY(fit.coefficients, fit_view_maps(seen, cloud.positions, settings.fit, progress));
  }
  chosen = fit.chosen;
  VoxelCloud voxels;
  voxels.grid = cloud.grid;
  voxels.positions = cloud.positions;
  return quantise_grid(voxels, std::move(fit), {0, 0, 0}, UpAxis::kUnknown, settings);
}

void look_from_views(const LightField& field, const PlenopticRecord& record, int threads,
                     PlenopticCloud& cloud) {
  const std::size_t points = cloud.num_points(), own = cloud.own_colour ? 1 : 0;
  const std::size_t row = 3 * cloud.num_colours();
  cloud.colours.resize(points * row);
  const ViewMaps maps(field, threads);
  parallel_ranges(points, kViewGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> some(end - begin);
    for (std::size_t p = begin; p < end; ++p) some[p - begin] = static_cast<std::uint32_t>(p);
    std::vector<std::array<float, 3>> colours(some.size()), sum(some.size());
    for (std::size_t v = 0; v < cloud.views; ++v) {
      maps.radiances(record.view_positions[v], some, colours);
      for (std::size_t i = 0; i < some.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) {
          sum[i][c] += colours[i][c];
          cloud.colours[(begin + i) * row + 3 * (own + v) + c] =
              static_cast<std::uint8_t>(std::lround(colours[i][c]));
        }
    }
    for (std::size_t i = 0; own == 1 && i < some.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c)
        cloud.colours[(begin + i) * row + c] =
            static_cast<std::uint8_t>(std::lround(sum[i][c] / float(cloud.views)));
  });
}

}  // namespace slf
