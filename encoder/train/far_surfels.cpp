// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/far_surfels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "capture/quantile.h"
#include "encoder/train/draw_surfels.h"

namespace slf {
namespace {

constexpr float kFarRadii = 3;      // radii of the viewed space
constexpr int kSquares = 20;        // along the longer side of a photograph: one surfel each
constexpr int kLeastSide = 4;       // pixels of a square
constexpr float kOpenShare = 0.7f;  // of a square through which one sees
constexpr float kFarReach = 2.2f;   // sides: radius, of which a disc shows a third or so
constexpr float kFarOpacity = 0.6f;
constexpr float kCoarser = 1.4f;

struct OpenSquare {
  Float3 position{}, colour{};
  float side = 0;  // world, there
};

Float3 unit_of(const Float3& v) {
  const float length = std::sqrt(std::max(dot(v, v), 1e-30f));
  return {v[0] / length, v[1] / length, v[2] / length};
}

/// Where a ray from within a sphere leaves it.
Float3 on_sphere(const Float3& from, const Float3& direction, const Float3& centre, float radius) {
  const Float3 to = minus(from, centre);
  const float along_ray = dot(to, direction);
  const float root =
      std::sqrt(std::max(along_ray * along_ray - dot(to, to) + radius * radius, 0.0f));
  return along(from, root - along_ray, direction);
}

/// Squares of a photograph through which one sees past all surfels.
void add_open_squares(const TrainingView& view, const DrawnSurfels& drawn, const ViewedSpace& space,
                      std::vector<OpenSquare>& squares) {
  const TrainingCamera& camera = view.camera;
  const int side = std::max(std::max(camera.width, camera.height) / kSquares, kLeastSide);
  const auto pixels = float(side * side);
  for (int top = 0; top + side <= camera.height; top += side)
    for (int left = 0; left + side <= camera.width; left += side) {
      float open = 0;
      OpenSquare square;
      for (int y = top; y < top + side; ++y)
        for (int x = left; x < left + side; ++x) {
          const std::size_t i = std::size_t(y) * std::size_t(camera.width) + std::size_t(x);
          open += drawn.transparency[i];
          for (std::size_t c = 0; c < 3; ++c) square.colour[c] += view.picture.plane(c)[i];
        }
      if (open < kOpenShare * pixels) continue;
      for (float& value : square.colour) value /= pixels;
      const Float3 in_camera = {(float(left) + float(side) / 2 - camera.cx) / camera.fx,
                                (float(top) + float(side) / 2 - camera.cy) / camera.fy, 1};
      Float3 direction{};
      for (std::size_t r = 0; r < 3; ++r)
        direction = along(direction, in_camera[r], camera.rotation[r]);
      square.position =
          on_sphere(camera.centre, unit_of(direction), space.centre, kFarRadii * space.radius);
      if (!std::isfinite(dot(square.position, square.position))) continue;
      const Float3 away = minus(square.position, camera.centre);
      square.side = std::sqrt(dot(away, away) / dot(in_camera, in_camera)) * float(side) /
                    std::max(camera.fx, camera.fy);
      squares.push_back(square);
    }
}

/// Means of those that fall into one cell of a grid.
std::vector<OpenSquare> merged_by_cell(const std::vector<OpenSquare>& squares, float cell) {
  using Key = std::array<std::int32_t, 3>;
  std::vector<std::pair<Key, std::uint32_t>> order(squares.size());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      order[i].first[a] =
          std::int32_t(std::clamp(std::floor(squares[i].position[a] / cell), -1e9f, 1e9f));
    order[i].second = std::uint32_t(i);
  }
  std::sort(order.begin(), order.end());
  std::vector<OpenSquare> out;
  for (std::size_t i = 0, j = 0; i < order.size(); i = j) {
    OpenSquare sum;
    for (; j < order.size() && order[j].first == order[i].first; ++j) {
      const OpenSquare& one = squares[order[j].second];
      sum.position = along(sum.position, 1, one.position);
      sum.colour = along(sum.colour, 1, one.colour);
    }
    const float share = 1 / float(j - i);
    out.push_back({along({}, share, sum.position), along({}, share, sum.colour), cell});
  }
  return out;
}

}  // namespace

ViewedSpace viewed_space(std::span<const TrainingView> views) {
  ViewedSpace space;
  std::vector<float> depths;
  for (const TrainingView& view : views) {
    space.centre = along(space.centre, 1 / float(views.size()), view.camera.centre);
    depths.push_back(view.camera.depth);
  }
  if (depths.empty()) return space;
  float spread = 0;
  for (const TrainingView& view : views) {
    const Float3 from = minus(view.camera.centre, space.centre);
    spread = std::max(spread, std::sqrt(dot(from, from)));
  }
  space.radius = spread + 2 * median(std::move(depths));
  return space;
}

TrainedSurfels far_surfels(std::span<const TrainingView> views, const TrainedSurfels& near,
                           std::size_t most, int threads) {
  const ViewedSpace space = viewed_space(views);
  std::vector<OpenSquare> squares;
  std::vector<float> sides;
  DrawnSurfels drawn;
  for (const TrainingView& view : views) {
    draw_surfels(tile_surfels(near, view.camera, threads), view, threads, drawn);
    add_open_squares(view, drawn, space, squares);
  }
  for (const OpenSquare& square : squares) sides.push_back(square.side);
  if (squares.empty() || most == 0) return {};
  float cell = median(std::move(sides));
  std::vector<OpenSquare> some = merged_by_cell(squares, cell);
  // Cells of half of the sphere are joined no further: those of its octants meet in its middle.
  while (some.size() > most && cell < kFarRadii * space.radius)
    some = merged_by_cell(squares, cell *= kCoarser);
  some.resize(std::min(some.size(), most));
  TrainedSurfels surfels;
  for (const OpenSquare& square : some) {
    TrainedSurfel surfel =
        flat_surfel(square.position, unit_of(minus(space.centre, square.position)),
                    kFarReach * square.side, kFarOpacity);
    for (std::size_t c = 0; c < 3; ++c)
      surfel.value[TrainedSurfel::kColour + c] = (square.colour[c] - 0.5f) / kMeanFunction;
    surfels.push_back(surfel);
  }
  return surfels;
}

}  // namespace slf
