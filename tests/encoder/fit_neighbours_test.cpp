// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_neighbours.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace slf::fit_neighbours_test {
namespace {

TEST(NearestNeighbours, BreakTiesByIndexAndLeaveOutThePointItself) {
  std::vector<Voxel> grid;
  for (std::int32_t z = 0; z < 6; ++z)
    for (std::int32_t y = 0; y < 6; ++y)
      for (std::int32_t x = 0; x < 6; ++x) grid.push_back({x, y, z});
  const Neighbours found = nearest_neighbours(grid, 8, 2);
  ASSERT_EQ(found.count, 8u);
  for (std::uint32_t p = 0; p < grid.size(); ++p) {
    std::vector<std::pair<int, std::uint32_t>> order;
    for (std::uint32_t q = 0; q < grid.size(); ++q) {
      int squared = 0;
      for (std::size_t a = 0; a < 3; ++a)
        squared += (grid[p][a] - grid[q][a]) * (grid[p][a] - grid[q][a]);
      if (q != p) order.push_back({squared, q});
    }
    std::sort(order.begin(), order.end());
    for (std::size_t n = 0; n < 8; ++n) EXPECT_EQ(found.of(p)[n], order[n].second) << p;
  }
}

TEST(NearestNeighbours, AreFewerWhereThereAreFewerPoints) {
  const std::vector<Voxel> three{{0, 0, 0}, {1, 0, 0}, {2097151, 2097151, 2097151}};
  const Neighbours found = nearest_neighbours(three, 8, 1);
  ASSERT_EQ(found.count, 2u);
  EXPECT_EQ(found.of(2)[0], 1u);
  EXPECT_EQ(nearest_neighbours(std::span(three).first(1), 8, 1).count, 0u);
}

}  // namespace
}  // namespace slf::fit_neighbours_test
