// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/train_surfels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <optional>
#include <utility>

#include "base/stopwatch.h"
#include "encoder/train/adam.h"
#include "encoder/train/camera_twists.h"
#include "encoder/train/chance.h"
#include "encoder/train/changed_views.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/grow_surfels.h"
#include "encoder/train/picture_loss.h"
#include "encoder/train/surface_pull.h"
#include "encoder/train/tile_pixels.h"
#include "encoder/train/training_checkpoint.h"
#include "encoder/train/training_digest.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kFirstTwist = 0.1, kLastTwist = 0.01;  // pixels: of cameras

// Pulls: of the iterations.
constexpr double kPullFirst = 0.4, kDecideFirst = 2.0 / 3;

// Growth.
constexpr double kGrowFirst = 0.05, kGrowLast = 0.6;  // of the iterations
constexpr int kGrowEvery = 100;
constexpr float kSmallest = 2.5f;  // pixels: radius of what splits

/// Every photograph once, then every one again in another order.
class Order {
 public:
  explicit Order(std::size_t views) : order_(views) { std::iota(order_.begin(), order_.end(), 0u); }
  std::size_t next() {
    if (at_ == 0)
      for (std::size_t i = order_.size(); i > 1; --i)
        std::swap(order_[i - 1], order_[std::size_t(chance_.next() % i)]);
    const std::size_t view = order_[at_];
    at_ = (at_ + 1) % order_.size();
    return view;
  }

 private:
  std::vector<std::uint32_t> order_;
  std::size_t at_ = 0;
  Chance chance_{1};
};

/// Which size of photographs an iteration has: 0 is the whole.
/// @param share  of the iterations, that each smaller size has
std::size_t level_at(double done, double share, std::size_t levels) {
  const auto passed = std::size_t(done / share);
  return passed + 1 >= levels ? 0 : levels - 1 - passed;
}

std::vector<std::vector<TrainingView>> pyramid(std::span<const TrainingView> views, int levels,
                                               int threads) {
  std::vector<std::vector<TrainingView>> coarser(std::size_t(std::max(levels - 1, 0)));
  for (std::size_t l = 0; l < coarser.size(); ++l) {
    coarser[l].resize(views.size());
    const auto from = l == 0 ? views : std::span<const TrainingView>(coarser[l - 1]);
    parallel_ranges(views.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) coarser[l][i] = half(from[i]);
    });
  }
  return coarser;
}

/// Tiles that have a surfel, and all between them: elsewhere a picture teaches nothing.
PictureBox drawn_box(const SurfelTiles& tiles, const TrainingCamera& camera) {
  int left = tiles.columns, right = 0, top = tiles.rows, bottom = 0;
  for (int y = 0; y < tiles.rows; ++y)
    for (int x = 0; x < tiles.columns; ++x) {
      const auto tile = std::size_t(y * tiles.columns + x);
      if (tiles.first[tile] == tiles.first[tile + 1]) continue;
      left = std::min(left, x), right = std::max(right, x + 1);
      top = std::min(top, y), bottom = std::max(bottom, y + 1);
    }
  if (right == 0) return {0, 0, 1, 1};
  const int x = left * kTileSide, y = top * kTileSide;
  return {x, y, std::min(right * kTileSide, camera.width) - x,
          std::min(bottom * kTileSide, camera.height) - y};
}

/// A pixel's opacities belong to one surface: to all of it, or to none.
void pull_opacities(float weight, const TrainedSurfels& surfels,
                    std::vector<TrainedSurfel>& gradients) {
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const float o = surfels[i].opacity();
    gradients[i].value[TrainedSurfel::kOpacity] += weight * (1 - 2 * o) * o * (1 - o);
  }
}

/// A training between two iterations.
class Training {
 public:
  Training(std::span<const TrainingView> views, const TrainSettings& settings,
           TrainedSurfels& surfels)
      : views_(views),
        settings_(settings),
        surfels_(surfels),
        coarser_(pyramid(views, settings.levels, settings.threads)),
        pixel_(training_pixel(views)),
        space_(viewed_space(views)),
        order_(views.size()),
        iteration_(int(settings.from * settings.iterations)) {
    adam_.resize(surfels.size());
    use_.resize(surfels.size());
  }

  int iteration() const { return iteration_; }

  TrainingState state() const {
    return {iteration_, drawn_views_, surfels_, adam_, use_, twists()};
  }
  std::vector<double> twists() const {
    return settings_.twists != nullptr ? settings_.twists->state() : std::vector<double>{};
  }
  void go_on_from(TrainingState state) {
    for (; iteration_ < state.iteration; ++iteration_) order_.next();
    drawn_views_ = state.drawn_views;
    surfels_ = std::move(state.surfels);
    adam_ = std::move(state.adam);
    use_ = std::move(state.use);
    if (settings_.twists != nullptr) settings_.twists->go_on_from(state.twists);
  }

  /// @param done  share of the schedule, below 1
  void step(double done) {
    const std::size_t level = level_at(done, settings_.coarse, coarser_.size() + 1);
    const std::size_t index = order_.next();
    const TrainingView& view = level == 0 ? views_[index] : coarser_[level - 1][index];
    const TrainingCamera camera =
        settings_.twists != nullptr ? settings_.twists->camera(index, view.camera) : view.camera;
    const SurfelTiles tiles = tile_surfels(surfels_, camera, settings_.threads);
    draw_surfels(tiles, view, settings_.threads, drawn_);
    // Similarity every second time, at twice the weight: it takes most of the loss's time.
    const LossShares shares = {iteration_ % 2 == 0 ? 2 * settings_.structure : 0,
                               settings_.squared};
    picture_loss(view, drawn_.picture, shares, drawn_box(tiles, view.camera), settings_.threads,
                 buffers_, loss_);
    const float focal = std::max(view.camera.fx, view.camera.fy);
    surfel_gradients(tiles, view, drawn_, loss_.gradient, settings_.spread * focal * focal,
                     settings_.threads, projected_);
    gradients_.assign(surfels_.size(), {});
    set_surfel_gradients(surfels_, camera, tiles, projected_.sums, gradients_, settings_.threads);
    if (settings_.twists != nullptr) move_camera(index, done);
    pull(done);
    use_.add(tiles, projected_.sums);
    if (settings_.changed != nullptr) leave_still();
    const TrainedSurfel rates =
        training_rates(done, pixel_ * std::pow(2.0, double(level)), settings_.harmonics);
    adam_step(gradients_, rates, space_, settings_.threads, adam_, surfels_);
    shrink_harmonics(settings_.harmonics.sparsity, rates, moving_, settings_.threads, surfels_);
    ++drawn_views_;
    if (done >= kGrowFirst && iteration_ % kGrowEvery == kGrowEvery - 1) {
      leave_out();
      if (done < kGrowLast) grow();
    }
    ++iteration_;
  }

 private:
  void pull(double done) {
    if (done > kPullFirst && settings_.together > 0) {
      // Anew where a checkpoint may be, too: it has no neighbours.
      if (neighbours_.index.size() != surfels_.size() * SurfelNeighbours::kCount ||
          iteration_ % kGrowEvery == 0)
        neighbours_ = surfel_neighbours(surfels_, settings_.threads);
      pull_together(neighbours_, settings_.together, float(pixel_), settings_.threads, surfels_,
                    gradients_);
    }
    if (done > kDecideFirst && settings_.decided > 0)
      pull_opacities(settings_.decided, surfels_, gradients_);
  }

  /// Without a gradient ever Adam leaves a value as it is.
  void leave_still() {
    if (moving_.size() != surfels_.size() || iteration_ % kGrowEvery == 0)
      moving_ = settings_.changed->shown_by(surfels_, settings_.threads);
    for (std::size_t i = 0; i < surfels_.size(); ++i)
      if (!moving_[i]) gradients_[i] = {}, use_.pull[i] = 0;
  }

  void move_camera(std::size_t view, double done) {
    const double rate = kFirstTwist * std::pow(kLastTwist / kFirstTwist, done);
    settings_.twists->step(view, rate, surfels_, gradients_);
    if (std::size_t(iteration_ + 1) % views_.size() == 0) settings_.twists->centre();
  }

  /// Here, so that the others learn to do without.
  void leave_out() {
    if (!settings_.belong) return;
    keep_surfels(settings_.belong(surfels_), use_, adam_, surfels_);
  }

  void grow() {
    GrowSettings grow;
    grow.most = settings_.surfels;
    if (views_.front().camera.gaussian) grow.axes = 3;
    grow.smallest = float(kSmallest * pixel_);
    grow.space = space_;
    grow.least_opacity = settings_.least_opacity;
    grow.replaced = settings_.replaced;
    grow.moving = moving_;
    grow.all_seen = drawn_views_ >= views_.size();
    grow_surfels(grow, use_, adam_, surfels_);
    drawn_views_ = 0;
  }

  std::span<const TrainingView> views_;
  const TrainSettings& settings_;
  TrainedSurfels& surfels_;
  std::vector<std::vector<TrainingView>> coarser_;
  double pixel_;
  ViewedSpace space_;
  AdamState adam_;
  SurfelUse use_;
  std::vector<TrainedSurfel> gradients_;
  std::vector<std::uint8_t> moving_;  // where some stand still
  SurfelNeighbours neighbours_;
  DrawnSurfels drawn_;
  ProjectedGradients projected_;
  SimilarityBuffers buffers_;
  PictureLoss loss_;
  Order order_;
  std::size_t drawn_views_ = 0;
  int iteration_;
};

}  // namespace

Result<Done, InputError> train_surfels(std::span<const TrainingView> views,
                                       const TrainSettings& settings, TrainedSurfels& surfels) {
  std::optional<TrainingCheckpoint> checkpoint;
  if (!settings.work.empty() && settings.seconds == 0)
    checkpoint.emplace(settings.work, digest_of_training(views, settings, surfels));
  Training training(views, settings, surfels);
  if (checkpoint && settings.resume)
    if (auto state = checkpoint->read(settings.iterations, training.twists().size()))
      training.go_on_from(*std::move(state));
  Stopwatch watch, saved;
  double unsaved = 0;           // seconds
  double late = settings.from;  // where the schedule is by the clock
  while (training.iteration() < settings.iterations) {
    const int i = training.iteration();
    if (settings.seconds > 0) late += (1 - settings.from) * watch.lap() / settings.seconds;
    const double done = std::max(double(i) / settings.iterations, late);
    if (done >= 1) return Done{};
    unsaved += saved.lap();
    if (checkpoint && i % kGrowEvery == 0 && unsaved >= settings.checkpoint_every) {
      SLF_CHECK(checkpoint->write(training.state()));
      unsaved = 0;
    }
    training.step(done);
    if (settings.progress && i % 50 == 0 && !settings.progress(done)) return Done{};
  }
  if (checkpoint) SLF_CHECK(checkpoint->write(training.state()));
  return Done{};
}

}  // namespace slf
