// SPDX-License-Identifier: Apache-2.0
#include "attributes/texture/charts.h"

#include <algorithm>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr int kMostExtentLog2 = 9;
constexpr std::uint32_t kLeastCells = 16;
constexpr std::int64_t kLeastFill = 8;  // one in so many pixels of a box

class ChartGrower {
 public:
  ChartGrower(const BlockGrid& grid, std::span<const std::uint64_t> morton, int depth,
              std::span<const std::uint8_t> axes)
      : grid_(grid),
        morton_(morton),
        axes_(axes),
        most_extent_(1 << std::min(depth, kMostExtentLog2)),
        pixel_owner_(static_cast<std::size_t>(4 * most_extent_ * most_extent_), kNobody),
        owner_(morton.size(), kNobody) {}

  bool taken(std::uint32_t cell) const { return owner_[cell] != kNobody; }

  /// Breadth first from a cell that is not taken. What it took is in members().
  Chart grow(std::uint32_t seed) {
    const std::uint8_t axis = axes_[grid_.block_of(seed)];
    seed_ = seed;
    origin_ = least_ = greatest_ = project(from_morton(morton_[seed]), axis);
    members_.clear();
    take(seed, origin_);
    for (std::size_t next = 0; next < members_.size(); ++next) {
      const std::uint32_t cell = members_[next];
      for (std::size_t d = 0; d < 27; ++d) {
        const std::int64_t there = grid_.neighbour(cell, morton_[cell], d);
        if (there < 0) continue;
        const auto n = static_cast<std::uint32_t>(there);
        if (taken(n) || axes_[grid_.block_of(n)] != axis) continue;
        const auto uv = project(from_morton(morton_[n]), axis);
        if (fits(uv) && pixel_owner_[pixel(uv)] != seed_) take(n, uv);
      }
    }
    return {axis, least_, {greatest_[0] - least_[0] + 1, greatest_[1] - least_[1] + 1}};
  }

  const std::vector<std::uint32_t>& members() const { return members_; }

 private:
  static constexpr std::uint32_t kNobody = Charts::kLoose;

  bool fits(const std::array<std::int32_t, 2>& uv) const {
    for (std::size_t a = 0; a < 2; ++a)
      if (std::max(greatest_[a], uv[a]) - std::min(least_[a], uv[a]) >= most_extent_) return false;
    return true;
  }

  /// The seed is in the middle of a square that holds every box around it.
  std::size_t pixel(const std::array<std::int32_t, 2>& uv) const {
    const std::int32_t u = uv[0] - origin_[0] + most_extent_, v = uv[1] - origin_[1] + most_extent_;
    return static_cast<std::size_t>(v * 2 * most_extent_ + u);
  }

  void take(std::uint32_t cell, const std::array<std::int32_t, 2>& uv) {
    owner_[cell] = seed_;
    pixel_owner_[pixel(uv)] = seed_;
    for (std::size_t a = 0; a < 2; ++a) {
      least_[a] = std::min(least_[a], uv[a]);
      greatest_[a] = std::max(greatest_[a], uv[a]);
    }
    members_.push_back(cell);
  }

  const BlockGrid& grid_;
  std::span<const std::uint64_t> morton_;
  std::span<const std::uint8_t> axes_;
  std::int32_t most_extent_;
  std::vector<std::uint32_t> pixel_owner_;  // seed of the chart that last had the pixel
  std::vector<std::uint32_t> owner_;        // [cells] seed of the chart, dissolved or not
  std::uint32_t seed_ = 0;
  std::array<std::int32_t, 2> origin_{}, least_{}, greatest_{};
  std::vector<std::uint32_t> members_;
};

bool worth_a_box(const Chart& chart, std::size_t cells) {
  const std::int64_t area = std::int64_t{in_box_steps(chart.extent[0])} *
                            in_box_steps(chart.extent[1]) * kBoxStep * kBoxStep;
  return cells >= kLeastCells && static_cast<std::int64_t>(cells) * kLeastFill >= area;
}

}  // namespace

Charts grow_charts(const BlockGrid& grid, std::span<const std::uint64_t> morton, int depth,
                   std::span<const std::uint8_t> axes) {
  Charts charts;
  charts.chart_of.assign(morton.size(), Charts::kLoose);
  ChartGrower grower(grid, morton, depth, axes);
  for (std::uint32_t cell = 0; cell < morton.size(); ++cell) {
    if (grower.taken(cell)) continue;
    const Chart chart = grower.grow(cell);
    if (!worth_a_box(chart, grower.members().size())) continue;
    for (const std::uint32_t member : grower.members())
      charts.chart_of[member] = static_cast<std::uint32_t>(charts.charts.size());
    charts.charts.push_back(chart);
  }
  return charts;
}

}  // namespace slf
