// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "attributes/encoder/raht_forward.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/raht_inverse.h"
#include "attributes/raht_tree.h"
#include "tests/codec/field_support.h"

namespace slf::raht_test {
namespace {

using test::codes;

TEST(Spec_8_6_1_Isqrt, IsTheFloorOfTheRoot) {
  for (const std::uint64_t n :
       {0ull, 1ull, 2ull, 3ull, 4ull, 99ull, 100ull, 1ull << 60, (1ull << 62) - 1, ~0ull}) {
    const std::uint64_t r = isqrt(n);
    EXPECT_LE(static_cast<unsigned __int128>(r) * r, n);
    EXPECT_GT(static_cast<unsigned __int128>(r + 1) * (r + 1), n);
  }
}

TEST(Spec_8_6_2_Rounding, TiesGoAwayFromZero) {
  const std::int64_t half = std::int64_t{1} << 29;
  EXPECT_EQ(rounded<30>(half), 1);
  EXPECT_EQ(rounded<30>(-half), -1);
  EXPECT_EQ(rounded<30>(half - 1), 0);
  EXPECT_EQ(rounded<30>(-half + 1), 0);
  EXPECT_EQ(rounded<30>(5 * half), 3);
  EXPECT_EQ(rounded<30>(-5 * half), -3);
}

class RahtTreeTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(RahtTreeTest, EveryRowButTheFirstIsMergedOnceParentsFirst) {
  const RahtTree tree = build_raht_tree(codes(GetParam().voxels));
  const std::size_t count = GetParam().voxels.size();
  ASSERT_EQ(tree.merges.size(), count - 1);
  ASSERT_EQ(tree.order.size(), count);
  std::vector<bool> merged(count), coded(count);
  for (const Merge& m : tree.merges) {
    EXPECT_LT(m.left, m.right);
    EXPECT_FALSE(merged[m.right]);
    if (tree.parent[m.right] != 0) {
      EXPECT_TRUE(merged[tree.parent[m.right]]);
      EXPECT_GT(tree.split[tree.parent[m.right]], tree.split[m.right]);
    }
    merged[m.right] = true;
    const double c = m.cos_q30, s = m.sin_q30, one = std::ldexp(1, 30);
    EXPECT_NEAR(std::hypot(c, s) / one, 1, 1e-8);
  }
  for (std::size_t i = 0; i < count; ++i) {
    EXPECT_FALSE(coded[tree.order[i]]);
    coded[tree.order[i]] = true;
    if (i < 2) continue;
    const std::uint32_t before = tree.order[i - 1], row = tree.order[i];
    EXPECT_TRUE(tree.split[before] > tree.split[row] ||
                (tree.split[before] == tree.split[row] && before < row));
  }
  EXPECT_EQ(tree.order[0], 0u);
}

TEST_P(RahtTreeTest, InverseGivesBackTheValuesToARoundingPerLevel) {
  const RahtTree tree = build_raht_tree(codes(GetParam().voxels));
  const int planes = 51;  // more than one lane block, not a multiple
  std::mt19937 random(1);
  std::vector<std::int32_t> values(GetParam().voxels.size() * planes);
  for (auto& v : values) v = static_cast<std::int32_t>(random() % 20001) - 10000;
  std::vector<std::int32_t> transformed = values;
  raht_forward(tree, planes, transformed, 1);
  std::vector<std::int32_t> threaded = values;
  raht_forward(tree, planes, threaded, 7);
  EXPECT_EQ(threaded, transformed);
  const std::vector<std::uint32_t> steps(planes, 1);
  ASSERT_TRUE(raht_inverse(tree, steps, transformed, 2));
  for (std::size_t i = 0; i < values.size(); ++i) ASSERT_NEAR(transformed[i], values[i], 5);
}

TEST_P(RahtTreeTest, EnergyIsKept) {
  const RahtTree tree = build_raht_tree(codes(GetParam().voxels));
  std::mt19937 random(2);
  std::vector<std::int32_t> values(GetParam().voxels.size());
  double before = 0, after = 0;
  for (auto& v : values)
    before += std::pow(v = static_cast<std::int32_t>(random() % 200001) - 100000, 2);
  raht_forward(tree, 1, values, 1);
  for (const auto v : values) after += std::pow(v, 2.0);
  EXPECT_NEAR(after / before, 1, 1e-4);
}

TEST_P(RahtTreeTest, AConstantHasNoDifferences) {
  const RahtTree tree = build_raht_tree(codes(GetParam().voxels));
  std::vector<std::int32_t> values(GetParam().voxels.size(), 1000);
  raht_forward(tree, 1, values, 1);
  const double root = std::sqrt(static_cast<double>(values.size()));
  EXPECT_NEAR(values[0], 1000 * root, root / 2 + 1);  // half a unit of the value
  for (std::size_t row = 1; row < values.size(); ++row) EXPECT_LE(std::abs(values[row]), 3);
}

INSTANTIATE_TEST_SUITE_P(Spec_8_6, RahtTreeTest, testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_8_2_Bounds, TheLargestCoefficientsDoNotOverflow) {
  // A path of 63 merges, every coefficient at its limit: the worst a stream can ask for.
  std::vector<std::uint64_t> path = {0};
  for (int bit = 0; bit < 63; ++bit) path.push_back(std::uint64_t{1} << bit);
  const RahtTree tree = build_raht_tree(path);
  for (const std::int32_t limit : {(1 << 27) - 1, -(1 << 27) + 1}) {
    std::vector<std::int32_t> values(path.size(), limit);
    ASSERT_TRUE(raht_inverse(tree, std::vector<std::uint32_t>{1}, values, 1));  // UBSan watches
    double energy = 0;
    for (const auto v : values) energy += std::pow(v, 2.0);
    EXPECT_NEAR(energy / (64 * std::pow(limit, 2.0)), 1, 1e-6);
  }
}

TEST(Spec_8_7_4_Reconstruction, CoefficientsOf2To27AreRefusedInEveryRow) {
  const RahtTree tree = build_raht_tree(std::vector<std::uint64_t>{0, 1, 2});
  const std::vector<std::uint32_t> steps = {1, 1000};
  for (std::size_t i = 0; i < 6; ++i) {
    const std::int32_t most = ((1 << 27) - 1) / static_cast<std::int32_t>(steps[i % 2]);
    for (const std::int32_t sign : {1, -1}) {
      std::vector<std::int32_t> values(6, 0);
      values[i] = sign * most;
      EXPECT_TRUE(raht_inverse(tree, steps, values, 1));
      values.assign(6, 0);
      values[i] = sign * (most + 1);
      EXPECT_FALSE(raht_inverse(tree, steps, values, 1));
    }
  }
}

TEST(Spec_8_6_Example, TwoPointsOfDifferentWeight) {
  // Three points: 0 and 1 merge at bit 0, their node with 2 (weight 2 : 1) at bit 1.
  const std::vector<std::uint64_t> three = {0, 1, 2};
  const RahtTree tree = build_raht_tree(three);
  std::vector<std::int32_t> values = {300, 100, 700};
  raht_forward(tree, 1, values, 1);
  EXPECT_NEAR(values[1], (100 - 300) / std::sqrt(2.0), 1);
  const double low = 400 / std::sqrt(2.0);
  EXPECT_NEAR(values[2], std::sqrt(2 / 3.0) * 700 - std::sqrt(1 / 3.0) * low, 1);
  EXPECT_NEAR(values[0], 1100 / std::sqrt(3.0), 1);
}

}  // namespace
}  // namespace slf::raht_test
