// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/held_out_pictures.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/stopwatch.h"
#include "encoder/fit/local_observations.h"
#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::size_t kFewestCameras = 8;
constexpr std::size_t kShare = 6;  // of the points is fitted again
constexpr std::size_t kFewestPoints = 2000, kMostPoints = 20000;
constexpr int kLargestCell = 5, kSmallestCell = 3;  // log2 of spacings: edges lose pixels
constexpr std::size_t kFewestCells = 12;

std::size_t cells_of(std::span<const Voxel> positions, int cell_log2) {
  std::size_t cells = 0;
  std::uint64_t last = std::numeric_limits<std::uint64_t>::max();
  for (const Voxel& v : positions) {
    const std::uint64_t cell = morton(v) >> (3 * cell_log2);
    cells += cell != last;
    last = cell;
  }
  return cells;
}

/// The observations that `kept` tells to keep; a camera's index is its argument.
template <class Kept>
Observations observations_that(const Observations& seen, std::span<const std::uint32_t> points,
                               const Kept& kept) {
  Observations part;
  part.first.push_back(0);
  for (const std::uint32_t p : points) {
    for (auto j = seen.first[p]; j < seen.first[p + 1]; ++j) {
      if (!kept(seen.camera[j])) continue;
      part.direction.push_back(seen.direction[j]);
      part.colour.push_back(seen.colour[j]);
      part.camera.push_back(seen.camera[j]);
    }
    part.first.push_back(part.direction.size());
  }
  set_gamma_range(part);
  return part;
}

/// [cameras] Those of the first fold that show something; none where cameras are few.
std::vector<bool> first_fold(const PictureViews& views, std::span<const int> fold) {
  std::vector<bool> held_out(views.views.size(), false);
  std::size_t seeing = 0;
  for (std::size_t v = 0; v < held_out.size(); ++v) {
    if (views.views[v].pixels() == 0) continue;
    ++seeing;
    held_out[v] = fold[v] == 0;
  }
  if (seeing < kFewestCameras) held_out.assign(held_out.size(), false);
  return held_out;
}

}  // namespace

std::vector<std::uint32_t> held_out_points(std::span<const Voxel> positions, int spacing_log2) {
  return spread_cells(positions, spacing_log2,
                      std::clamp(positions.size() / kShare, kFewestPoints, kMostPoints));
}

Observations observations_of(const Observations& seen, std::span<const std::uint32_t> points) {
  return observations_that(seen, points, [](std::uint16_t) { return true; });
}

std::vector<std::uint32_t> spread_cells(std::span<const Voxel> positions, int spacing_log2,
                                        std::size_t about) {
  const std::size_t every =
      std::max<std::size_t>(positions.size() / std::max<std::size_t>(about, 1), 1);
  int cell_log2 = spacing_log2 + kLargestCell;
  while (cell_log2 > spacing_log2 + kSmallestCell &&
         cells_of(positions, cell_log2) < kFewestCells * every)
    --cell_log2;
  std::vector<std::uint32_t> points;
  std::size_t cell = 0;
  for (std::size_t p = 0; p < positions.size(); ++p) {
    if (p > 0 && (morton(positions[p]) ^ morton(positions[p - 1])) >> (3 * cell_log2) != 0) ++cell;
    if (cell % every == every / 2) points.push_back(static_cast<std::uint32_t>(p));
  }
  return points;
}

Result<std::shared_ptr<const HeldOutPictures>, InputError> HeldOutPictures::of(const Input& input) {
  Stopwatch watch;
  std::shared_ptr<HeldOutPictures> pictures(new HeldOutPictures);
  const std::vector<bool> held_out = first_fold(input.views, input.fold);
  pictures->cameras_ = static_cast<std::size_t>(std::count(held_out.begin(), held_out.end(), true));
  if (pictures->cameras_ > 0) {
    const std::span<const Voxel> all = input.of.positions;
    const auto points = held_out_points(all, input.settings.normal_cell_log2);
    pictures->views_ = views_of_points(input.views, points, all.size(), held_out);
    for (const PictureView& view : pictures->views_.views) pictures->pixels_ += view.pixels();
    if (pictures->pixels_ > 0) SLF_CHECK(pictures->fit(input, points, held_out));
  }
  pictures->seconds_ = watch.lap();
  return std::shared_ptr<const HeldOutPictures>(std::move(pictures));
}

/// Without the cameras that are held out. One round to pictures: with less to go by, at the edges
/// of cells too, a second makes up more (every fourth camera of a synth die held out: 25.38 dB,
/// with a second 25.05; blender_can 30.78 and 30.82).
Result<Done, InputError> HeldOutPictures::fit(const Input& input,
                                              std::span<const std::uint32_t> points,
                                              const std::vector<bool>& held_out) {
  const PictureFitInput& of = input.of;
  grid_ = of.grid;
  const std::size_t row = input.coefficients.size() / of.positions.size();
  for (const std::uint32_t p : points) {
    positions_.push_back(of.positions[p]);
    const auto fitted = input.coefficients.subspan(row * p, row);
    coded_.insert(coded_.end(), fitted.begin(), fitted.end());
  }
  std::vector<std::uint32_t> all(points.size());
  std::iota(all.begin(), all.end(), 0u);
  std::vector<bool> used(held_out.size());
  std::vector<bool> saw(std::size_t{std::numeric_limits<std::uint16_t>::max()} + 1, true);
  for (std::size_t v = 0; v < held_out.size(); ++v) {
    used[v] = !held_out[v];
    saw[static_cast<std::size_t>(of.cameras[v])] = used[v];
  }
  SLF_TRY(coefficients_,
          fit_view_maps(observations_that(*of.seen, all, [&](std::size_t c) { return saw[c]; }),
                        positions_, input.settings, {}));
  const auto system_of = [&](PictureViews& views) {
    return std::make_unique<PictureSystem>(grid_, positions_, input.settings, of.gamma_range, views,
                                           std::vector<Vec3>(input.eyes.begin(), input.eyes.end()));
  };
  if (input.pull > 0) {
    PictureViews views = views_of_points(input.views, points, of.positions.size(), used);
    const auto system = system_of(views);
    const PictureFitSettings& s = input.settings.pictures;
    auto colours = system->colours(coefficients_);
    PictureSystem::Vector z(colours.size());
    system->set_pull(input.pull);
    system->set_trust(colours, s.outlier);
    system->improve([](std::size_t) { return true; }, s.steps, colours, &z);
    system->add(z, coefficients_);
  }
  system_ = system_of(views_);
  return Done{};
}

double HeldOutPictures::mean_squared_change(std::span<const float> from,
                                            std::span<const float> to) const {
  PictureError sum;
  for (const PictureError& e : system_->changes(system_->colours(from), system_->colours(to)))
    sum += e;
  return sum.squares / (3 * sum.trust);
}

double HeldOutPictures::mean_squared_error(std::span<const float> coefficients) const {
  PictureError sum;
  for (const PictureError& e : system_->errors(system_->colours(coefficients))) sum += e;
  return sum.squares / (3 * sum.trust);
}

}  // namespace slf
