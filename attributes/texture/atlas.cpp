// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/atlas.h"

#include <algorithm>
#include <array>
#include <numeric>

#include "attributes/raht_tree.h"
#include "attributes/texture/block_axes.h"
#include "attributes/texture/box_packing.h"
#include "attributes/texture/charts.h"
#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::int32_t kLeastSize = 64, kMostSize = 8192;
constexpr std::int32_t kTile = 8;  // side of a tile of loose points

/// The smallest multiple of 8 that is not less.
std::int32_t whole_tiles(std::int64_t size) {
  return static_cast<std::int32_t>((size + kTile - 1) / kTile * kTile);
}

/// The cells that hold points, and the first point of each; and one past the last.
struct Cells {
  std::vector<std::uint64_t> morton;
  std::vector<std::uint32_t> first;
};

Cells cells_of(std::span<const std::uint64_t> morton, int cell_log2) {
  Cells cells;
  for (std::size_t i = 0; i < morton.size(); ++i) {
    const std::uint64_t cell = morton[i] >> (3 * cell_log2);
    if (!cells.morton.empty() && cells.morton.back() == cell) continue;
    cells.morton.push_back(cell);
    cells.first.push_back(static_cast<std::uint32_t>(i));
  }
  cells.first.push_back(static_cast<std::uint32_t>(morton.size()));
  return cells;
}

bool is_upright(const Chart& chart) { return chart.extent[1] > chart.extent[0]; }

/// Spec 8.11.4: boxes of the charts, lying, in packing order; `order` says whose they are.
std::vector<Box> boxes_of(const std::vector<Chart>& charts, std::vector<std::uint32_t>& order) {
  const auto box_of = [&](std::uint32_t c) {
    const auto [least, most] = std::minmax(charts[c].extent[0], charts[c].extent[1]);
    return Box{in_box_steps(most), in_box_steps(least), 0, 0};
  };
  order.resize(charts.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    const Box left = box_of(a), right = box_of(b);
    return std::array{left.height, left.width} > std::array{right.height, right.width};
  });
  std::vector<Box> boxes;
  for (const std::uint32_t c : order) boxes.push_back(box_of(c));
  return boxes;
}

std::int32_t atlas_width(const std::vector<Box>& boxes, std::size_t loose) {
  std::uint64_t area = loose;
  std::int32_t widest = 0;
  for (const Box& box : boxes) {
    area += static_cast<std::uint64_t>(box.width * box.height * kBoxStep * kBoxStep);
    widest = std::max(widest, box.width * kBoxStep);
  }
  const auto square = static_cast<std::int64_t>(isqrt(area * 5 / 4));
  return std::max({kLeastSize, whole_tiles(square), whole_tiles(widest)});
}

/// Even bits of a tile's 2-D Morton code.
constexpr std::size_t gather_by_two(std::size_t v) { return (v & 1) | (v >> 1 & 2) | (v >> 2 & 4); }

/// Spec 8.11.5: loose point n in tiles, row by row, below y.
std::uint32_t loose_pixel(std::size_t n, const Atlas& atlas, std::int32_t y) {
  const std::size_t width = static_cast<std::size_t>(atlas.width), in_row = width / kTile;
  const std::size_t tile = n / (kTile * kTile), within = n % (kTile * kTile);
  const std::size_t px = tile % in_row * kTile + gather_by_two(within);
  const std::size_t py =
      static_cast<std::size_t>(y) + tile / in_row * kTile + gather_by_two(within >> 1);
  return static_cast<std::uint32_t>(py * width + px);
}

}  // namespace

Result<Atlas> derive_atlas(std::span<const std::uint64_t> morton, int depth, int cell_log2) {
  const Cells cells = cells_of(morton, cell_log2);
  const int cell_depth = std::max(depth - cell_log2, 0);
  const BlockGrid grid(cells.morton, cell_depth);
  const Charts grown = grow_charts(grid, cells.morton, cell_depth, block_axes(grid, cells.morton));
  Atlas atlas;
  atlas.num_charts = grown.charts.size();
  atlas.num_loose = morton.size() - cells.morton.size() +
                    static_cast<std::size_t>(
                        std::count(grown.chart_of.begin(), grown.chart_of.end(), Charts::kLoose));
  std::vector<std::uint32_t> order;
  std::vector<Box> packed = boxes_of(grown.charts, order);
  atlas.width = atlas_width(packed, atlas.num_loose);
  const std::int32_t below =
      whole_tiles(std::int64_t{pack_boxes(packed, atlas.width / kBoxStep)} * kBoxStep);
  const std::size_t tiles = (atlas.num_loose + kTile * kTile - 1) / (kTile * kTile),
                    in_row = static_cast<std::size_t>(atlas.width / kTile);
  const std::int64_t height =
      below + static_cast<std::int64_t>((tiles + in_row - 1) / in_row) * kTile;
  if (height > kMostSize) return Error{Errc::kLimitExceeded, "texture_size"};
  atlas.height = std::max(kLeastSize, static_cast<std::int32_t>(height));

  std::vector<Box> boxes(packed.size());  // by chart
  for (std::size_t i = 0; i < packed.size(); ++i) boxes[order[i]] = packed[i];
  atlas.pixel.resize(morton.size());
  std::size_t loose = 0;
  for (std::size_t c = 0; c < cells.morton.size(); ++c) {
    std::uint32_t point = cells.first[c];
    if (const std::uint32_t index = grown.chart_of[c]; index != Charts::kLoose) {
      const Chart& chart = grown.charts[index];
      auto uv = project(from_morton(cells.morton[c]), chart.axis);
      for (std::size_t a = 0; a < 2; ++a) uv[a] -= chart.least[a];
      if (is_upright(chart)) std::swap(uv[0], uv[1]);
      const std::int32_t x = boxes[index].x * kBoxStep + uv[0],
                         y = boxes[index].y * kBoxStep + uv[1];
      atlas.pixel[point++] = static_cast<std::uint32_t>(y * atlas.width + x);
    }
    for (; point < cells.first[c + 1]; ++point)
      atlas.pixel[point] = loose_pixel(loose++, atlas, below);
  }
  return atlas;
}

}  // namespace slf
