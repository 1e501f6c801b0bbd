// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/outlines.h"

#include <algorithm>
#include <array>
#include <optional>

#include "capture/object_outline.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr double kOutlined = 0.8;  // of the photographs, for a hull
constexpr double kMissed = 0.04;   // of the outlines that a place may lie outside of
constexpr double kSeen = 0.3;      // of the cameras, by which a place is judged

/// Whether the object may be at the point: in its photograph, half a cell to either side.
/// Nothing: it lies outside of the photograph.
std::optional<bool> may_show(const Outline& outline, const Vec3& at, double half_side) {
  double depth = 0;
  const auto image = outline.camera->project(at, &depth);
  if (!image) return {};
  const int width = outline.camera->width, height = outline.camera->height;
  const double u = (*image)[0], v = (*image)[1];
  if (!(u >= 0 && v >= 0 && u < width && v < height)) return {};
  const double reach = std::min(outline.camera->fx * half_side / depth, double(width));
  for (const auto& [du, dv] : {std::array{0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}) {
    const auto x = std::clamp(int(u + du * reach), 0, width - 1);
    const auto y = std::clamp(int(v + dv * reach), 0, height - 1);
    if (outline.object[std::size_t(y) * std::size_t(width) + std::size_t(x)]) return true;
  }
  return false;
}

}  // namespace

bool in_hull(const std::vector<Outline>& outlines, const Vec3& at, double half_side) {
  std::size_t seen = 0, missed = 0;
  for (const Outline& outline : outlines) {
    const auto shows = may_show(outline, at, half_side);
    seen += shows.has_value();
    missed += shows.has_value() && !*shows;
    if (double(missed) > 1 + kMissed * double(outlines.size())) return false;
  }
  return double(seen) >= kSeen * double(outlines.size());
}

Result<std::vector<Outline>, InputError> outlines_of(const Capture& capture,
                                                     std::span<const int> cameras, int threads,
                                                     Background background) {
  std::vector<Outline> outlines(cameras.size());
  std::vector<std::optional<InputError>> failures(cameras.size());
  parallel_ranges(cameras.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      auto photograph = load_image(capture, cameras[i]);
      if (!photograph) {
        failures[i] = photograph.error();
        continue;
      }
      const auto object = object_outline(*photograph, background);
      outlines[i] = {&capture.cameras[std::size_t(cameras[i])], {object.begin(), object.end()}};
    }
  });
  for (const auto& failure : failures)
    if (failure) return *failure;
  std::erase_if(outlines, [](const Outline& outline) { return outline.object.empty(); });
  return outlines;
}

bool are_outlined(std::size_t outlines, std::size_t cameras) {
  return double(outlines) >= kOutlined * double(cameras);
}

}  // namespace slf
