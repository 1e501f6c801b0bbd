// SPDX-License-Identifier: Apache-2.0
// What nodes of a slab have in common. Spec 8.4.8.
#include "geometry/occupancy_slabs.h"

#include <gtest/gtest.h>

#include <vector>

#include "geometry/morton.h"

namespace slf::occupancy_slabs_test {
namespace {

constexpr unsigned kLowerX = 0x55;

/// Nodes of x = 3 have children in their lower half along x alone.
OccupancySlabs with_lower_halves() {
  OccupancySlabs slabs;
  for (std::int32_t i = 0; i < 20; ++i) slabs.store({3, i, 2 * i}, kLowerX);
  return slabs;
}

TEST(Spec_8_4_8_Slabs, TellWhichHalvesOfANodeHoldNoChild) {
  const auto classes = with_lower_halves().children({3, 1000, 2000});
  for (std::size_t c = 0; c < 8; ++c) {
    const std::uint64_t of_child = classes >> 8 * c & 255;
    EXPECT_EQ(of_child & 3, c % 2 == 0 ? 3u : 0u) << c;
    EXPECT_EQ(of_child >> 2, 2u + 4 * 2) << c;  // of y and z nothing is known
  }
}

TEST(Spec_8_4_8_Slabs, PlacesGoToTheirAxes) {
  OccupancySlabs slabs;
  const Voxel node{1, 2, 3};
  for (int i = 0; i < 20; ++i) slabs.place(1, {0, 0, 3}).update(1);
  for (int i = 0; i < 20; ++i) slabs.place(2, {0, 2, 0}).update(0);
  EXPECT_EQ(slabs.place(0, node).axis, 3u);
  EXPECT_EQ(slabs.place(0, node).sixteenth(), 8u);
  EXPECT_GT(slabs.place(1, node).input, 500);
  EXPECT_LT(slabs.place(3, node).input, -500);
  for (unsigned place = 4; place < 8; ++place) EXPECT_EQ(slabs.place(place, node).input, 0);
}

TEST(Spec_8_4_8_Slabs, AreNewAtEveryLevelForFewNodesAndForMany) {
  for (const std::size_t nodes : {1u, 3000u}) {
    OccupancySlabs slabs;
    std::vector<std::uint64_t> cells;
    for (std::size_t i = 0; i < nodes; ++i) {
      const auto x = static_cast<std::int32_t>(i + 5000);
      cells.push_back(morton({x, x, x}));
      slabs.store({x, x, x}, kLowerX);
      slabs.place(7, {x, x, x}).update(1);
    }
    slabs.finish_level(cells, 14);
    const OccupancySlabs fresh;
    for (const std::uint64_t cell : cells) {
      ASSERT_EQ(slabs.children(from_morton(cell)), fresh.children(from_morton(cell)));
      ASSERT_EQ(slabs.place(7, from_morton(cell)).input, 0);
    }
  }
}

}  // namespace
}  // namespace slf::occupancy_slabs_test
