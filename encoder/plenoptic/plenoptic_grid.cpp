// SPDX-License-Identifier: Apache-2.0
#include "encoder/plenoptic/plenoptic_grid.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "base/input_error.h"
#include "capture/plenoptic_order.h"
#include "slf/plenoptic_frames.h"

namespace slf {
namespace {

using Place = std::array<std::int64_t, 3>;

constexpr int kMostGridBits = 21;
constexpr double kMostVoxels = 1e15;  // from one grid to the other: whole numbers in a double

/// Where a grid begins, in voxels of another.
Result<Place, InputError> voxels_between(const Grid& grid, const Grid& other) {
  if (grid.step != other.step)
    return invalid_input(
        "voxels have another size than those of the frames before: whole coordinates give all "
        "frames one grid");
  Place place{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double voxels = (other.origin[k] - grid.origin[k]) / grid.step;
    if (voxels != std::round(voxels) || !(std::abs(voxels) <= kMostVoxels))
      return invalid_input("voxels lie between those of the frames before");
    place[k] = static_cast<std::int64_t>(voxels);
  }
  return place;
}

}  // namespace

Result<Done, InputError> PlenopticGrid::add(const PlenopticCloud& cloud) {
  if (!first_) {
    first_ = cloud.grid;
    low_ = high_ = {cloud.positions[0][0], cloud.positions[0][1], cloud.positions[0][2]};
  }
  SLF_TRY(const Place begin, voxels_between(*first_, cloud.grid));
  same_origin_ = same_origin_ && begin == Place{};
  first_->bits = std::max(first_->bits, cloud.grid.bits);
  for (const Voxel& v : cloud.positions)
    for (std::size_t k = 0; k < 3; ++k) {
      low_[k] = std::min(low_[k], begin[k] + v[k]);
      high_[k] = std::max(high_[k], begin[k] + v[k]);
    }
  return Done{};
}

Result<Grid, InputError> PlenopticGrid::grid() const {
  Grid grid = *first_;
  if (same_origin_) return grid;
  std::int64_t most = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.origin[k] += grid.step * static_cast<double>(low_[k]);
    most = std::max(most, high_[k] - low_[k]);
  }
  grid.bits = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(most)));
  if (grid.bits > kMostGridBits)
    return invalid_input("points of all frames do not fit one grid of 21 bits");
  return grid;
}

Result<Done, InputError> check_same_views(const PlenopticCloud& first,
                                          const PlenopticCloud& cloud) {
  if (cloud.views != first.views)
    return invalid_input(std::to_string(cloud.views) + " views, and the frames before have " +
                         std::to_string(first.views));
  for (std::size_t p = 0; p < std::max(cloud.properties.size(), first.properties.size()); ++p) {
    const auto text = [p](const PlenopticCloud& of) {
      return p < of.properties.size() ? of.properties[p].type + " " + of.properties[p].name
                                      : std::string("nothing");
    };
    if (text(cloud) != text(first))
      return invalid_input("property " + std::to_string(p) + " is " + text(cloud) +
                           ", in the frames before " + text(first));
  }
  if (cloud.view_positions != first.view_positions)
    return invalid_input(
        "positions of views are not those of the frames before (--views FILE says them for all)");
  SLF_CHECK(voxels_between(first.grid, cloud.grid));
  return Done{};
}

Result<PlenopticCloud, InputError> on_grid_of_voxels(PlenopticCloud cloud, const Grid& grid) {
  SLF_TRY(const Place begin, voxels_between(grid, cloud.grid));
  cloud.grid = grid;
  const std::int64_t most = std::int64_t{1} << grid.bits;
  for (Voxel& v : cloud.positions)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t at = begin[k] + v[k];
      if (at < 0 || at >= most) return invalid_input("a point lies beyond the grid of all frames");
      v[k] = static_cast<std::int32_t>(at);
    }
  if (begin == Place{}) return cloud;
  sort_by_voxels(cloud);
  return cloud;
}

}  // namespace slf
