// SPDX-License-Identifier: Apache-2.0
// Blocks of points, and what is between them.
#include "encoder/fit/block_tree.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/codec/field_support.h"

namespace slf::block_tree_test {
namespace {

std::vector<Voxel> plane(std::int32_t side) {
  std::vector<Voxel> positions;
  for (std::int32_t y = 0; y < side; ++y)
    for (std::int32_t x = 0; x < side; ++x) positions.push_back({x, y, 5});
  return test::sorted_distinct(positions);
}

/// What is between blocks of a plane at a point, where each has the value of its middle along x.
float between(const BlockTree& tree, std::span<const Voxel> positions, int side,
              const Voxel& point) {
  const BlockBlend blend = tree.around(point);
  float value = 0;
  for (std::size_t i = 0; i < blend.count; ++i) {
    const auto block = positions[tree.first(0, blend.block[i])][0] / side;
    value +=
        blend.weight[i] * (static_cast<float>(block * side) + static_cast<float>(side - 1) / 2);
  }
  return value;
}

TEST(BlockTree, LevelsHoldThePointsInOrder) {
  const auto positions = test::sphere_cloud(5);
  const BlockTree tree(positions, 2);
  std::size_t below = positions.size();
  for (std::size_t level = 0; level < tree.levels(); ++level) {
    EXPECT_EQ(tree.first(level, 0), 0u);
    EXPECT_EQ(tree.first(level, tree.blocks(level)), below);
    for (std::size_t b = 0; b < tree.blocks(level); ++b)
      EXPECT_LT(tree.first(level, b), tree.first(level, b + 1));
    below = tree.blocks(level);
  }
  EXPECT_EQ(below, 1u);
}

TEST(BlockTree, WhatIsLinearInBlocksIsLinearBetweenTheirMiddles) {
  const auto positions = plane(32);
  const BlockTree tree(positions, 3);
  for (std::int32_t x = 4; x < 28; ++x)
    EXPECT_NEAR(static_cast<double>(between(tree, positions, 8, {x, 9, 5})), x, 1e-5);
}

TEST(BlockTree, WeightsSumToOneAndTheOwnBlockCounts) {
  const auto positions = test::sphere_cloud(5);
  for (const int log2 : {0, 1, 3, 5}) {
    const BlockTree tree(positions, log2);
    for (std::size_t b = 0; b < tree.blocks(0); ++b)
      for (std::size_t p = tree.first(0, b); p < tree.first(0, b + 1); ++p) {
        const BlockBlend blend = tree.around(positions[p]);
        float own = 0;
        for (std::size_t i = 0; i < blend.count; ++i)
          if (blend.block[i] == b) own = blend.weight[i];
        EXPECT_GE(own, 0.125f);
        EXPECT_NEAR(
            static_cast<double>(std::accumulate(blend.weight.begin(), blend.weight.end(), 0.0f)), 1,
            1e-6);
      }
  }
}

TEST(BlockTree, BlocksOfOneVoxelHaveNothingBetweenThem) {
  const auto positions = plane(4);
  const BlockTree tree(positions, 0);
  for (std::size_t p = 0; p < positions.size(); ++p) {
    const BlockBlend blend = tree.around(positions[p]);
    EXPECT_EQ(blend.count, 1u);
    EXPECT_EQ(blend.block[0], p);
  }
}

TEST(BlockTree, ABlockAloneIsItsOwnPrior) {
  const std::vector<Voxel> positions = {{0, 0, 0}, {1, 0, 0}, {900, 900, 900}};
  const BlockTree tree(positions, 3);
  EXPECT_EQ(tree.around(positions[1]).count, 1u);
  EXPECT_EQ(tree.around(positions[2]).count, 1u);
  EXPECT_EQ(tree.around(positions[2]).block[0], 1u);
  for (std::size_t level = 0; level + 1 < tree.levels(); ++level)
    for (std::size_t b = 0; b < tree.blocks(level); ++b) EXPECT_GE(tree.above(level, b).count, 1u);
}

}  // namespace
}  // namespace slf::block_tree_test
