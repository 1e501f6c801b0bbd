// SPDX-License-Identifier: Apache-2.0
// Prediction between levels of the largest values, and of parts of a tree. Spec 8.7.6, 8.8.2.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "attributes/raht_inverse.h"
#include "level_prediction_support.h"

namespace slf::level_prediction_bounds_test {
namespace {

using test::Values;

class PredictionBounds : public testing::TestWithParam<test::NamedCloud> {};

// Spec 8.8.2; UBSan watches. Every plane has modes of its own on every level.
TEST_P(PredictionBounds, TheLargestCoefficientsStayInBounds) {
  const auto codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(codes);
  constexpr std::size_t kPlanes = 53;
  const std::vector<std::uint32_t> steps(kPlanes, 1);
  std::mt19937 random(9);
  Values coefficients(tree.size() * kPlanes);
  for (auto& v : coefficients) v = random() % 2 ? (1 << 27) - 1 : 1 - (1 << 27);
  std::vector<PredictedPlanes> planes;
  for (std::size_t j = 0; j < kPlanes; ++j) {
    planes.push_back({j, j + 1, {}});
    for (int l = 0; l < GetParam().bits; ++l)
      planes.back().modes.push_back(static_cast<std::uint8_t>(j < 2 ? j : random() % 4));
  }
  TransformLevels one(codes, GetParam().bits, 0), many(codes, GetParam().bits, 0);
  Values values = coefficients, threaded = coefficients, plain = coefficients;
  ASSERT_TRUE(raht_inverse_predicted(tree, one, planes, steps, values, 1));
  ASSERT_TRUE(raht_inverse_predicted(tree, many, planes, steps, threaded, 3));
  EXPECT_EQ(values, threaded);
  ASSERT_TRUE(raht_inverse(tree, steps, plain, 1));
  for (std::size_t row = 0; row < tree.size(); ++row) {
    EXPECT_EQ(values[row * kPlanes], plain[row * kPlanes]);  // plane 0 has all levels off
    if (tree.size() > 1) {
      EXPECT_LE(std::abs(values[row * kPlanes + 1]), kPredictedLimit);
    }
  }
}

/// Every plane with modes of its own on every level from `start` on.
std::vector<PredictedPlanes> planes_of_any_mode(std::size_t count, int start, int levels) {
  std::vector<PredictedPlanes> planes;
  for (std::size_t j = 0; j < count; ++j) {
    planes.push_back({j, j + 1, {}});
    for (int l = start; l < levels; ++l)
      planes.back().modes.push_back(
          static_cast<std::uint8_t>((j + 3 * static_cast<std::size_t>(l)) % 4));
  }
  return planes;
}

// Spec 8.6.4, 8.7.6: from a level on, everything is as without what is above.
TEST_P(PredictionBounds, FromTheCellsOnIsTheSameAsFromTheRoot) {
  const int bits = GetParam().bits;
  const auto codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(codes);
  constexpr std::size_t kPlanes = 6;
  const std::vector<std::uint32_t> steps(kPlanes, 9);
  std::mt19937 random(10);
  Values coefficients(tree.size() * kPlanes);
  for (auto& v : coefficients) v = static_cast<std::int32_t>(random() % 401) - 200;
  Values whole = coefficients;
  TransformLevels all(codes, bits, 0);
  ASSERT_TRUE(
      raht_inverse_predicted(tree, all, planes_of_any_mode(kPlanes, 0, bits), steps, whole, 1));
  for (int start = 1; start < bits; ++start) {
    const RahtTop top = build_raht_top(codes, 3 * (bits - start));
    Values above(top.tree.size() * kPlanes), cut = coefficients;
    for (std::size_t i = 0; i < above.size(); ++i)
      above[i] = coefficients[top.first[i / kPlanes] * kPlanes + i % kPlanes];
    TransformLevels upper(codes, bits, bits - start), lower(codes, bits, 0, start);
    EXPECT_EQ(lower.count(), bits - start);
    ASSERT_TRUE(raht_inverse_predicted(top.tree, upper, planes_of_any_mode(kPlanes, 0, start),
                                       steps, above, 1));
    for (std::size_t i = 0; i < above.size(); ++i)
      cut[top.first[i / kPlanes] * kPlanes + i % kPlanes] = above[i];
    ASSERT_TRUE(raht_inverse_predicted(tree, lower, planes_of_any_mode(kPlanes, start, bits), steps,
                                       cut, 2, {}, kAllPlanes, top.tree.size()));
    EXPECT_EQ(cut, whole);
  }
}

// Spec 8.2, 8.8.2; UBSan watches. A base of a scene of 2^24 points.
TEST_P(PredictionBounds, TheLargestWeightsAndCoefficientsStayInBounds) {
  const auto codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(codes);
  const auto weight = static_cast<std::uint32_t>(
      std::min((std::size_t{1} << 24) / codes.size(), std::size_t{1} << 22));
  constexpr std::size_t kPlanes = 50;
  const std::vector<std::uint32_t> steps(kPlanes, 1);
  std::mt19937 random(11);
  Values values(tree.size() * kPlanes);
  for (auto& v : values) v = random() % 2 ? (1 << 27) - 1 : 1 - (1 << 27);
  const auto before = test::weights_alike(codes.size(), weight);
  TransformLevels levels(codes, GetParam().bits, 0, 0, CodeWeights(before));
  ASSERT_TRUE(raht_inverse_predicted(tree, levels, planes_of_any_mode(kPlanes, 0, GetParam().bits),
                                     steps, values, 1));
}

TEST_P(PredictionBounds, WeightsOfABaseMoveNoCentre) {
  const auto codes = test::codes(GetParam().voxels);
  const auto before = test::weights_by_chance(codes.size(), 4);
  TransformLevels one(codes, GetParam().bits, 0),
      many(codes, GetParam().bits, 0, 0, CodeWeights(before));
  for (int l = 0; l < one.count(); ++l) {
    const auto a = one.next().child_places;
    const auto& b = many.next();
    ASSERT_EQ(a.size(), b.child_places.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].centre, b.child_places[n].centre);
      EXPECT_EQ(before[b.child_rows[n + 1]] - before[b.child_rows[n]], b.child_places[n].weight);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_6, PredictionBounds,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

// The heaviest cells there can be: four of 2^22 points. UBSan watches.
TEST(Spec_8_8_2_Bounds, TheHeaviestCellsOfABaseDoNotOverflow) {
  const std::vector<std::uint64_t> codes = {0, 1, 2, 4 * 8 + 7};
  const auto before = test::weights_alike(codes.size(), 1u << 22);
  const RahtTree tree = build_raht_tree(codes, CodeWeights(before));
  for (const PredictionMode mode : {kWide, kSharpDamped, kSharp})
    for (const std::int32_t sign : {1, -1}) {
      Values values = {sign * ((1 << 27) - 1), -sign * ((1 << 27) - 1), sign * ((1 << 27) - 1),
                       -sign * ((1 << 27) - 1)};
      TransformLevels levels(codes, 2, 0, 0, CodeWeights(before));
      const std::vector<PredictedPlanes> planes = {{0, 1, {mode, mode}}};
      ASSERT_TRUE(
          raht_inverse_predicted(tree, levels, planes, std::vector<std::uint32_t>{1}, values, 1));
      for (const auto v : values) EXPECT_LE(std::abs(v), kPredictedLimit);
    }
}

}  // namespace
}  // namespace slf::level_prediction_bounds_test
