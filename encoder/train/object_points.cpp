// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/object_points.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "capture/density.h"
#include "encoder/measure/outlines.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kCamerasAtFirst = 16;
constexpr std::size_t kPointsAtFirst = 4096;
constexpr double kElsewhere = 0.25;  // of the points
constexpr double kSlack = 0.04;      // of a photograph's width: hulls and noise lie about an object

/// Evenly from first to last.
template <class T>
std::vector<T> some_of(std::span<const T> all, std::size_t most) {
  std::vector<T> some;
  const std::size_t count = std::min(all.size(), most);
  for (std::size_t i = 0; i < count; ++i) some.push_back(all[i * all.size() / count]);
  return some;
}

int widest(const Capture& capture, std::span<const int> cameras) {
  int width = 0;
  for (const int c : cameras) width = std::max(width, capture.cameras[std::size_t(c)].width);
  return width;
}

/// [points] 1: the object may be there.
std::vector<std::uint8_t> within(const std::vector<Outline>& outlines,
                                 std::span<const std::array<float, 3>> points, double slack,
                                 int threads) {
  std::vector<std::uint8_t> inside(points.size());
  parallel_ranges(points.size(), 256, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      inside[p] = in_hull(outlines, {points[p][0], points[p][1], points[p][2]}, slack);
  });
  return inside;
}

template <class T>
void keep(const std::vector<std::uint8_t>& wanted, std::vector<T>& of) {
  std::size_t kept = 0;
  for (std::size_t p = 0; p < of.size(); ++p)
    if (wanted[p]) of[kept++] = of[p];
  of.resize(kept);
}

}  // namespace

Result<ObjectPoints, InputError> object_points(const Capture& capture, std::span<const int> cameras,
                                               int threads) {
  using Points = std::span<const std::array<float, 3>>;
  const Points all = capture.cloud.positions;
  const double pixel = choose_density(capture, cameras).pixel;
  const double slack = kSlack * double(widest(capture, cameras)) * pixel;
  const auto elsewhere = [&](const std::vector<Outline>& outlines, Points points) {
    const auto inside = within(outlines, points, slack, threads);
    return double(std::count(inside.begin(), inside.end(), 0)) > kElsewhere * double(points.size());
  };
  const std::vector<int> some = some_of(cameras, kCamerasAtFirst);
  SLF_TRY(std::vector<Outline> outlines, outlines_of(capture, some, threads));
  if (!are_outlined(outlines.size(), some.size())) return ObjectPoints{};
  if (!elsewhere(outlines, some_of(all, kPointsAtFirst))) return ObjectPoints{};
  SLF_TRY(outlines, outlines_of(capture, cameras, threads));
  if (!are_outlined(outlines.size(), cameras.size())) return ObjectPoints{};
  const auto inside = within(outlines, all, slack, threads);
  ObjectPoints own{capture.cloud, std::size_t(std::count(inside.begin(), inside.end(), 0))};
  if (double(own.left_out) <= kElsewhere * double(all.size())) return ObjectPoints{};
  keep(inside, own.cloud.positions);
  if (!own.cloud.normals.empty()) keep(inside, own.cloud.normals);
  if (!own.cloud.colours.empty()) keep(inside, own.cloud.colours);
  return own;
}

}  // namespace slf
