// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/train_surfels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>

#include "base/stopwatch.h"
#include "encoder/train/adam.h"
#include "encoder/train/chance.h"
#include "encoder/train/draw_surfels.h"
#include "encoder/train/grow_surfels.h"
#include "encoder/train/picture_loss.h"
#include "encoder/train/surface_pull.h"
#include "slf/parallel.h"

namespace slf {
namespace {

// Steps of Adam. Positions in pixels, from the first to the last iteration.
constexpr double kFirstMove = 0.15, kLastMove = 0.004;
constexpr float kTurnRate = 5e-3f, kRadiusRate = 1e-2f, kOpacityRate = 5e-2f;
constexpr float kColourRate = 5e-3f, kHarmonicRate = 1.5e-3f;
constexpr double kTail = 0.15;  // of the iterations: rates fall to a tenth

// Pulls: of the iterations.
constexpr double kPullFirst = 0.4, kDecideFirst = 2.0 / 3;

// Growth.
constexpr double kGrowFirst = 0.05, kGrowLast = 0.6;  // of the iterations
constexpr int kGrowEvery = 100;
constexpr float kSmallest = 2.5f;  // pixels: radius of what splits

// Shares of the iterations that the coarser photographs have.
constexpr double kCoarseShare = 0.25;

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

TrainedSurfel rates_at(double done, double pixel) {
  TrainedSurfel rates;
  const auto tail = float(done > 1 - kTail ? std::pow(0.1, (done - (1 - kTail)) / kTail) : 1);
  const auto move = float(pixel * kFirstMove * std::pow(kLastMove / kFirstMove, done));
  for (std::size_t k = 0; k < TrainedSurfel::kSize; ++k)
    rates.value[k] = k < TrainedSurfel::kTurn         ? move
                     : k < TrainedSurfel::kLogRadius  ? tail * kTurnRate
                     : k < TrainedSurfel::kOpacity    ? tail * kRadiusRate
                     : k < TrainedSurfel::kColour     ? tail * kOpacityRate
                     : k < TrainedSurfel::kColour + 3 ? tail * kColourRate
                                                      : tail * kHarmonicRate;
  return rates;
}

/// Which size of photographs an iteration has: 0 is the whole.
std::size_t level_at(double done, std::size_t levels) {
  const auto passed = std::size_t(done / kCoarseShare);
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

/// A pixel's opacities belong to one surface: to all of it, or to none.
void pull_opacities(float weight, const TrainedSurfels& surfels,
                    std::vector<TrainedSurfel>& gradients) {
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const float o = surfels[i].opacity();
    gradients[i].value[TrainedSurfel::kOpacity] += weight * (1 - 2 * o) * o * (1 - o);
  }
}

}  // namespace

void train_surfels(std::span<const TrainingView> views, const TrainSettings& settings,
                   TrainedSurfels& surfels) {
  const auto coarser = pyramid(views, settings.levels, settings.threads);
  const double pixel = training_pixel(views);
  AdamState state;
  state.resize(surfels.size());
  SurfelUse use;
  use.resize(surfels.size());
  std::vector<TrainedSurfel> gradients;
  SurfelNeighbours neighbours;
  DrawnSurfels drawn;
  LossBuffers buffers;
  PictureLoss loss;
  Order order(views.size());
  std::size_t drawn_views = 0;
  Stopwatch watch;
  double late = settings.from;  // where the schedule is by the clock
  for (int i = int(settings.from * settings.iterations); i < settings.iterations; ++i) {
    if (settings.seconds > 0) late += (1 - settings.from) * watch.lap() / settings.seconds;
    const double done = std::max(double(i) / settings.iterations, late);
    if (done >= 1) return;
    const std::size_t level = level_at(done, coarser.size() + 1);
    const std::size_t index = order.next();
    const TrainingView& view = level == 0 ? views[index] : coarser[level - 1][index];
    const SurfelTiles tiles = tile_surfels(surfels, view.camera, settings.threads);
    draw_surfels(tiles, view, settings.threads, drawn);
    // Similarity every second time, at twice the weight: it takes most of the loss's time.
    picture_loss(view, drawn.picture, i % 2 == 0 ? 2 * settings.structure : 0, settings.threads,
                 buffers, loss);
    const float focal = std::max(view.camera.fx, view.camera.fy);
    const auto projected = surfel_gradients(tiles, view, drawn, loss.gradient,
                                            settings.spread * focal * focal, settings.threads);
    gradients.assign(surfels.size(), {});
    add_surfel_gradients(surfels, view.camera, tiles, projected, gradients, settings.threads);
    if (done > kPullFirst &&
        (neighbours.index.size() != surfels.size() * SurfelNeighbours::kCount ||
         i % kGrowEvery == 0))
      neighbours = surfel_neighbours(surfels, settings.threads);
    if (done > kPullFirst)
      pull_together(neighbours, settings.together, float(pixel), settings.threads, surfels,
                    gradients);
    if (done > kDecideFirst) pull_opacities(settings.decided, surfels, gradients);
    use.add(tiles, projected);
    adam_step(gradients, rates_at(done, pixel * std::pow(2.0, double(level))), settings.threads,
              state, surfels);
    ++drawn_views;
    const bool grows = done >= kGrowFirst && done < kGrowLast;
    if (grows && i % kGrowEvery == kGrowEvery - 1) {
      GrowSettings grow;
      grow.most = settings.surfels;
      grow.smallest = float(kSmallest * pixel);
      grow.all_seen = drawn_views >= views.size();
      grow_surfels(grow, use, state, surfels);
      drawn_views = 0;
    }
    if (settings.progress && i % 50 == 0 && !settings.progress(done)) return;
  }
}

}  // namespace slf
