// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/empty_pixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "encoder/measure/outlines.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kMargin = 1.5;        // pixels of the view, around the object, that may show it
constexpr float kCostOfHiding = 0.1f;  // of a whole pixel, in units of colours: docs/decisions/072

/// How many pixels of the object there are above and to the left.
class ObjectCounts {
 public:
  explicit ObjectCounts(const Outline& outline)
      : width_(outline.camera->width), height_(outline.camera->height) {
    const auto width = std::size_t(width_), height = std::size_t(height_);
    sums_.resize((width + 1) * (height + 1));
    for (std::size_t y = 0; y < height; ++y)
      for (std::size_t x = 0; x < width; ++x)
        sums_[at(x + 1, y + 1)] = sums_[at(x, y + 1)] + sums_[at(x + 1, y)] - sums_[at(x, y)] +
                                  outline.object[y * width + x];
  }

  /// Whether the square around a place, in pixels, has none.
  bool is_empty(const std::array<double, 2>& place, double reach) const {
    const auto column = [&](double x) { return std::size_t(std::clamp<double>(x, 0, width_)); };
    const auto row = [&](double y) { return std::size_t(std::clamp<double>(y, 0, height_)); };
    const std::size_t left = column(std::floor(place[0] - reach)),
                      right = column(std::ceil(place[0] + reach)),
                      top = row(std::floor(place[1] - reach)),
                      bottom = row(std::ceil(place[1] + reach));
    return sums_[at(right, bottom)] + sums_[at(left, top)] ==
           sums_[at(right, top)] + sums_[at(left, bottom)];
  }

 private:
  std::size_t at(std::size_t x, std::size_t y) const { return y * std::size_t(width_ + 1) + x; }

  int width_, height_;
  std::vector<std::uint32_t> sums_;
};

void charge(const Outline& outline, TrainingView& view) {
  const ObjectCounts object(outline);
  Camera lens = *outline.camera;
  lens.rotation = Camera{}.rotation;
  lens.translation = {0, 0, 0};
  const TrainingCamera& camera = view.camera;
  const double scale = lens.fx / double(camera.fx);  // a power of two
  view.hiding.assign(view.picture.pixels(), 0);
  std::size_t i = 0;
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x, ++i) {
      const auto place = lens.project({(x + 0.5 - double(camera.cx)) / double(camera.fx),
                                       (y + 0.5 - double(camera.cy)) / double(camera.fy), 1});
      if (place && object.is_empty(*place, kMargin * scale)) view.hiding[i] = kCostOfHiding;
    }
}

}  // namespace

Result<Done, InputError> charge_for_hiding(const Capture& capture, int threads,
                                           std::span<TrainingView> views) {
  std::vector<std::optional<InputError>> failures(views.size());
  parallel_ranges(views.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto own = outlines_of(capture, {&views[i].index, 1}, 1, Background::kCertain);
      if (!own)
        failures[i] = own.error();
      else if (!own->empty())
        charge(own->front(), views[i]);
    }
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  return Done{};
}

}  // namespace slf
