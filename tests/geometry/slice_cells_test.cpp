// SPDX-License-Identifier: Apache-2.0
// What a slice takes over from the base. Spec 8.6.4.
#include "attributes/slice_cells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "attributes/raht_forward.h"
#include "attributes/raht_inverse.h"
#include "tests/codec/field_support.h"

namespace slf::slice_cells_test {
namespace {

constexpr std::uint32_t kMost = 1u << 22;

std::vector<std::uint32_t> one_row_a_point(std::size_t points) {
  std::vector<std::uint32_t> first(points + 1);
  std::iota(first.begin(), first.end(), 0u);
  return first;
}

class SliceCellsTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(SliceCellsTest, AreTheRunsOfPointsThatShareACode) {
  const auto points = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(points);
  for (int level = 0; level < GetParam().bits; ++level) {
    const int below = GetParam().bits - level;
    const auto cells = find_cells(tree, one_row_a_point(points.size()), 3 * below, 5);
    EXPECT_EQ(cells.first, 5u);
    ASSERT_EQ(cells.size(), test::cells_of(points, below).size());
    std::size_t row = 0;
    for (std::size_t i = 0; i < cells.size(); ++i) {
      ASSERT_EQ(cells.row[i], row);
      for (std::size_t end = row + cells.weight[i]; row < end; ++row)
        EXPECT_EQ(points[row] >> (3 * below), points[cells.row[i]] >> (3 * below));
    }
    EXPECT_EQ(row, points.size());
  }
}

TEST_P(SliceCellsTest, CoarserRowsCountAllTheirPoints) {
  const auto points = test::codes(GetParam().voxels);
  const int bits = GetParam().bits;
  if (bits < 2) GTEST_SKIP() << "one level";
  const RahtTop top = build_raht_top(points, 3);
  const auto cells = find_cells(top.tree, top.first, 3 * (bits - 1), 0);
  EXPECT_EQ(std::accumulate(cells.weight.begin(), cells.weight.end(), std::size_t{0}),
            points.size());
  EXPECT_EQ(cells.size(), test::cells_of(points, bits - 1).size());
}

// Spec 8.8: the merges of the cells are the same, wherever their values come from.
TEST_P(SliceCellsTest, ATransformCutAtTheCellsGivesWhatTheWholeGives) {
  const auto points = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(points);
  const std::vector<std::uint32_t> steps = {3, 5};
  std::mt19937 random(1);
  std::vector<std::int32_t> coefficients(points.size() * 2);
  for (auto& v : coefficients) v = static_cast<std::int32_t>(random() % 2001) - 1000;
  std::vector<std::int32_t> whole = coefficients;
  ASSERT_TRUE(raht_inverse(tree, steps, whole, 1));
  for (int below = 1; below < GetParam().bits; ++below) {
    const RahtTop top = build_raht_top(points, 3 * below);
    std::vector<std::int32_t> above(top.tree.size() * 2), cut = coefficients;
    for (std::size_t i = 0; i < above.size(); ++i)
      above[i] = coefficients[top.first[i / 2] * 2 + i % 2];
    ASSERT_TRUE(raht_inverse(top.tree, steps, above, 1));
    for (std::size_t i = 0; i < above.size(); ++i) cut[top.first[i / 2] * 2 + i % 2] = above[i];
    ASSERT_TRUE(raht_inverse(tree, steps, cut, 1, {}, kAllPlanes, top.tree.size()));
    EXPECT_EQ(cut, whole);
  }
}

TEST_P(SliceCellsTest, TheForwardTransformLeavesSumsOverRootsInThem) {
  const auto points = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(points);
  const auto components = test::smooth_components(GetParam().voxels, 1, 2000, 4);
  for (int below = 1; below < GetParam().bits; ++below) {
    const auto cells = find_cells(tree, one_row_a_point(points.size()), 3 * below, 0);
    std::vector<std::int32_t> values = components;
    raht_forward(tree, 3, values, 1, cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (std::size_t c = 0; c < 3; ++c) {
        double sum = 0;
        for (std::size_t p = 0; p < cells.weight[i]; ++p)
          sum += components[(cells.row[i] + p) * 3 + c];
        EXPECT_NEAR(values[cells.row[i] * 3 + c], sum / std::sqrt(cells.weight[i]), 3 * below);
      }
  }
}

TEST_P(SliceCellsTest, ABaseGivesBackTheValuesToARounding) {
  const auto points = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(points);
  const auto components = test::smooth_components(GetParam().voxels, 1, 2000, 4);
  const auto cells = find_cells(tree, one_row_a_point(points.size()), 3, 0);
  const std::vector<std::vector<std::uint32_t>> all = {test::weights_alike(cells.size(), 1),
                                                       test::weights_alike(cells.size(), 1000),
                                                       test::weights_by_chance(cells.size(), 3)};
  for (const auto& before : all) {
    const CodeWeights weights(before);
    std::vector<std::int32_t> values = components, base(cells.size() * 3);
    raht_forward(tree, 3, values, 1, cells.size());
    put_into_base(cells, values, weights, 3, base);
    start_from_base(cells, base, weights, 3, values);
    ASSERT_TRUE(raht_inverse(tree, std::vector<std::uint32_t>(3, 1), values, 1, {}, kAllPlanes,
                             cells.size()));
    // Half a unit of the base, which counts the root of its weight less, and one for each of three
    // merges.
    for (std::size_t i = 0; i < cells.size(); ++i)
      for (std::size_t v = 3 * cells.row[i]; v < 3 * (cells.row[i] + cells.weight[i]); ++v)
        EXPECT_NEAR(values[v], components[v], 0.5 / std::sqrt(weights.of(i)) + 3);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_6_4, SliceCellsTest,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_6_4_WeightChange, IsTheRootOfTheRatioToNearest) {
  EXPECT_EQ(WeightChange(7, 7)(-12345), -12345);
  EXPECT_EQ(WeightChange(1, 4)(10), 20);
  EXPECT_EQ(WeightChange(4, 1)(7), 4);  // 3.5, ties away from zero
  EXPECT_EQ(WeightChange(4, 1)(-7), -4);
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const auto from = static_cast<std::uint32_t>(random() % kMost + 1),
               to = static_cast<std::uint32_t>(random() % kMost + 1);
    const auto value = static_cast<std::int32_t>(random() % (1u << 20)) - (1 << 19);
    const double exact = value * std::sqrt(double{1} * to / from);
    EXPECT_NEAR(WeightChange(from, to)(value), exact, 0.51 + std::abs(value) * 0x1p-19);
  }
}

// UBSan watches.
TEST(Spec_8_6_4_WeightChange, StaysWithin2To29WhateverItIsGiven) {
  for (const std::int32_t value :
       {std::numeric_limits<std::int32_t>::max(), std::numeric_limits<std::int32_t>::min(), 0, 1}) {
    EXPECT_LE(std::abs(WeightChange(1, kMost)(value)), 1 << 29);
    EXPECT_LE(std::abs(WeightChange(1, 1)(value)), 1 << 29);
    EXPECT_LE(std::abs(WeightChange(kMost, 1)(value)), 1 << 20);
  }
  EXPECT_EQ(WeightChange(1, kMost)(1), 1 << 11);
  EXPECT_EQ(WeightChange(kMost, 1)(1 << 11), 1);
}

}  // namespace
}  // namespace slf::slice_cells_test
