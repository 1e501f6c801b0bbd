// SPDX-License-Identifier: Apache-2.0
#include "capture/crop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <vector>

#include "base/vec3.h"
#include "capture/keep_marked.h"
#include "capture/quantile.h"

namespace slf {
namespace {

/// Tells whether positions from `origin` are in a box of the world.
class Inside {
 public:
  Inside(const Vec3& origin, const WorldBox& box) {
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(box.low[k], box.high[k]) - origin[k];
      high_[k] = std::max(box.low[k], box.high[k]) - origin[k];
    }
  }

  bool operator()(const Vec3& p) const {
    for (std::size_t k = 0; k < 3; ++k)
      if (!(p[k] >= low_[k] && p[k] <= high_[k])) return false;
    return true;
  }

 private:
  Vec3 low_{}, high_{};
};

void crop_points(PointCloud& cloud, const Inside& inside) {
  std::vector<bool> kept;
  for (const auto& p : cloud.positions) kept.push_back(inside(to_double(p)));
  keep_marked(cloud.positions, kept);
  keep_marked(cloud.normals, kept);
  keep_marked(cloud.colours, kept);
}

void crop_triangles(Mesh& mesh, const Inside& inside) {
  std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    Vec3 centroid{0, 0, 0};
    for (const std::uint32_t vertex : triangle)
      for (std::size_t k = 0; k < 3; ++k)
        centroid[k] += double{mesh.vertices.positions[vertex][k]} / 3;
    return !inside(centroid);
  });
}

/// Along an axis: how wide all points are, and most of them; a box about the most.
struct Extent {
  double all, most, low, high;
};

Extent extent_along(std::span<const std::array<float, 3>> positions, std::size_t axis) {
  constexpr double kTail = 0.01;  // of the points at either end, which may be anywhere
  std::vector<float> values;
  for (const auto& p : positions) values.push_back(p[axis]);
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  const double first = quantile(values, kTail), last = quantile(values, 1 - kTail);
  const double margin = (last - first) / 2;
  return {double{*high} - double{*low}, last - first, std::max(double{*low}, first - margin),
          std::min(double{*high}, last + margin)};
}

}  // namespace

Result<Done, InputError> crop(Mesh& mesh, const Vec3& origin, const WorldBox& box) {
  const Inside inside(origin, box);
  const bool surface = !mesh.triangles.empty();
  surface ? crop_triangles(mesh, inside) : crop_points(mesh.vertices, inside);
  if (surface ? mesh.triangles.empty() : mesh.vertices.positions.empty())
    return InputError{Errc::kInvalidInput, "nothing is inside the box to crop to"};
  return Done{};
}

std::string far_points_warning(const PointCloud& cloud, const Vec3& origin) {
  return far_points_warning(cloud.positions, origin, "points", "the cloud");
}

std::string far_points_warning(std::span<const std::array<float, 3>> positions, const Vec3& origin,
                               const char* points, const char* whole) {
  constexpr double kWide = 4;  // two bits of the grid
  constexpr std::size_t kFewest = 100;
  if (positions.size() < kFewest) return "";
  std::array<Extent, 3> extent{};
  double all = 0, most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    extent[k] = extent_along(positions, k);
    all = std::max(all, extent[k].all);
    most = std::max(most, extent[k].most);
  }
  if (!(all > kWide * most) || most == 0) return "";
  char text[400];
  std::snprintf(text, sizeof text,
                "a few %s far away make %s %.10g times as wide as it is, and its grid as coarse; "
                "without them: --crop=%.10g,%.10g,%.10g,%.10g,%.10g,%.10g",
                points, whole, std::round(all / most), extent[0].low + origin[0],
                extent[1].low + origin[1], extent[2].low + origin[2], extent[0].high + origin[0],
                extent[1].high + origin[1], extent[2].high + origin[2]);
  return text;
}

}  // namespace slf
