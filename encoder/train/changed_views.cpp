// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/changed_views.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "encoder/measure/changed_pixels.h"
#include "encoder/train/draw_surfels.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr int kAround = 24;    // pixels that a change is trained with: its surfels reach there
constexpr int kLeastBox = 64;  // pixels: of what is trained, for windows and coarser sizes
constexpr float kChangedLight =
    0.25f;  // pixels of a quarter of the side: fewer are an edge's light
constexpr float kChangedShare = 0.02f;  // of all that a surfel shows

using Mask = std::vector<std::uint8_t>;

Image eight_bits(const PlanarPicture& picture) {
  Image image{picture.width, picture.height, 3, {}};
  image.data.resize(3 * picture.pixels());
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t p = 0; p < picture.pixels(); ++p)
      image.data[3 * p + c] =
          static_cast<std::uint8_t>(std::lround(255 * std::clamp(picture.plane(c)[p], 0.0f, 1.0f)));
  return image;
}

bool is_same_camera(const TrainingCamera& a, const TrainingCamera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy && a.rotation == b.rotation && a.translation == b.translation;
}

Mask mask_of(const TrainingView& before, const TrainingView& now) {
  if (!is_same_camera(before.camera, now.camera)) return Mask(now.picture.pixels(), 1);
  return changed_pixels(eight_bits(before.picture), eight_bits(now.picture));
}

void keep_changed(const Mask& mask, const TrainingView& now, TrainingView& before) {
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t p = 0; p < mask.size(); ++p)
      if (mask[p]) before.picture.plane(c)[p] = now.picture.plane(c)[p];
}

struct Span {
  int first, count;
};

/// `kAround` to either side of [low, high], and no less than `kLeastBox`, within a picture.
Span around(int low, int high, int side) {
  const int grown = std::max(kLeastBox - (high - low + 1), 2 * kAround) / 2;
  const int first = std::max(low - grown, 0);
  return {first, std::min(high + 1 + grown, side) - first};
}

void crop(const float* plane, int width, Span x, Span y, float* cropped) {
  for (int row = 0; row < y.count; ++row)
    std::copy_n(plane + std::ptrdiff_t{y.first + row} * width + x.first, x.count,
                cropped + std::ptrdiff_t{row} * x.count);
}

/// A box of a picture, which its camera sees alone.
TrainingView cropped(const TrainingView& view, Span x, Span y) {
  const int width = view.picture.width;
  TrainingView out = view;
  out.camera.width = x.count, out.camera.height = y.count;
  out.camera.cx -= static_cast<float>(x.first), out.camera.cy -= static_cast<float>(y.first);
  out.picture = {x.count, y.count, {}};
  out.picture.value.resize(3 * out.picture.pixels());
  for (std::size_t c = 0; c < 3; ++c)
    crop(view.picture.plane(c), width, x, y, out.picture.plane(c));
  if (view.hiding.empty()) return out;
  out.hiding.resize(out.picture.pixels());
  crop(view.hiding.data(), width, x, y, out.hiding.data());
  return out;
}

/// The camera's box around a change, and in its first plane what has changed.
struct Change {
  TrainingView view, marks;
};
std::vector<Change> changes_of(const TrainingView& now, const Mask& mask) {
  int left = now.camera.width, right = -1, top = now.camera.height, bottom = -1;
  for (int y = 0, p = 0; y < now.camera.height; ++y)
    for (int x = 0; x < now.camera.width; ++x, ++p)
      if (mask[static_cast<std::size_t>(p)]) {
        left = std::min(left, x), right = std::max(right, x);
        top = std::min(top, y), bottom = std::max(bottom, y);
      }
  if (right < 0) return {};
  const Span x = around(left, right, now.camera.width), y = around(top, bottom, now.camera.height);
  TrainingView marks = now;
  marks.hiding.clear();
  std::fill(marks.picture.value.begin(), marks.picture.value.end(), 0.0f);
  for (std::size_t p = 0; p < mask.size(); ++p) marks.picture.value[p] = mask[p];
  return {{cropped(now, x, y), half(half(cropped(marks, x, y)))}};
}

}  // namespace

ChangedViews::ChangedViews(std::vector<TrainingView>& before, std::vector<TrainingView> now,
                           int threads) {
  std::vector<std::vector<Change>> changes(now.size());
  parallel_ranges(now.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Mask mask = mask_of(before[i], now[i]);
      changes[i] = changes_of(now[i], mask);
      if (is_same_camera(before[i].camera, now[i].camera))
        keep_changed(mask, now[i], before[i]);
      else
        before[i] = now[i];
    }
  });
  for (std::vector<Change>& of_view : changes)
    for (Change& change : of_view) {
      views_.push_back(std::move(change.view));
      marks_.push_back(std::move(change.marks));
    }
}

std::vector<std::uint8_t> ChangedViews::shown_by(const TrainedSurfels& surfels, int threads) const {
  std::vector<float> changed(surfels.size()), drawn(surfels.size());
  DrawnSurfels picture;
  ProjectedGradients gradients;
  for (const TrainingView& marks : marks_) {
    const SurfelTiles tiles = tile_surfels(surfels, marks.camera, threads);
    draw_surfels(tiles, marks, threads, picture);
    surfel_gradients(tiles, marks, picture, marks.picture, 0, threads, gradients);
    for (std::size_t i = 0; i < tiles.projected.size(); ++i) {
      changed[tiles.projected[i].surfel] += gradients.sums[i].colour[0];
      drawn[tiles.projected[i].surfel] += gradients.sums[i].drawn;
    }
  }
  std::vector<std::uint8_t> shown(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i)
    shown[i] = changed[i] > kChangedLight && changed[i] > kChangedShare * drawn[i];
  return shown;
}

}  // namespace slf
