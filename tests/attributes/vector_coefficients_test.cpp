// SPDX-License-Identifier: Apache-2.0
// Vectors of quantised coefficients, there and back. Spec 8.7.2.
#include <gtest/gtest.h>

#include <random>

#include "attributes/vector_coefficients.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "tests/codec/field_support.h"

namespace slf::vector_coefficients_test {
namespace {

/// Coefficients of a slice in groups and two ranges, and how they are coded.
struct CodedSlice {
  explicit CodedSlice(const std::vector<Voxel>& voxels, std::vector<std::vector<std::uint16_t>> f)
      : tree(build_raht_tree(test::codes(voxels))), groups(std::move(f)) {
    for (const auto& functions : groups) planes += 3 * functions.size();
    neighbours =
        find_coefficient_neighbours(tree, test::codes(voxels), test::one_row_a_point(tree.size()));
    values.resize(planes * tree.size());
  }

  /// Runs both coders over the units of the first `count` groups; the units by (range, group).
  template <class Code>
  void for_each_unit(std::size_t count, const Code& code) const {
    std::vector<VectorCoefficients> models;
    for (const auto& functions : groups) models.emplace_back(functions, tree.size());
    const std::array<std::size_t, 3> ends = {0, order_end(tree, 3), tree.size()};
    for (std::size_t range = 0; range < 2; ++range)
      for (std::size_t g = 0; g < count; ++g)
        code(models[g], g > 0 ? &models[g - 1] : nullptr, ends[range], ends[range + 1],
             range * groups.size() + g);
  }

  std::vector<std::vector<std::uint8_t>> encode() {
    std::vector<std::vector<std::uint8_t>> units;
    const CoefficientRows rows{tree, values, planes};
    for_each_unit(groups.size(), [&](VectorCoefficients& model, const VectorCoefficients* lower,
                                     std::size_t begin, std::size_t end, std::size_t) {
      RangeEncoder encoder;
      EXPECT_TRUE(model.code(encoder, rows, neighbours, lower, begin, end));
      units.push_back(encoder.finish());
    });
    return units;
  }

  /// False where a unit is refused.
  bool decode(const std::vector<std::vector<std::uint8_t>>& units, std::size_t count,
              std::vector<std::int32_t>& decoded) const {
    decoded.assign(values.size(), 0);
    const CoefficientRows rows{tree, decoded, planes};
    bool sound = true;
    for_each_unit(count, [&](VectorCoefficients& model, const VectorCoefficients* lower,
                             std::size_t begin, std::size_t end, std::size_t unit) {
      if (!sound) return;
      RangeDecoder decoder(units[unit]);
      sound = model.code(decoder, rows, neighbours, lower, begin, end) && decoder.finish("test");
    });
    return sound;
  }

  RahtTree tree;
  std::vector<std::vector<std::uint16_t>> groups;
  std::size_t planes = 0;
  CoefficientNeighbours neighbours;
  std::vector<std::int32_t> values;
};

class VectorCoefficientsTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(VectorCoefficientsTest, GivesBackValuesOfEverySize) {
  CodedSlice slice(GetParam().voxels, {{0}, {1, 3}, {2, 4, 5}});
  std::mt19937 random(1);
  for (auto& v : slice.values) {
    const auto bits = static_cast<int>(random() % 28);  // to the largest a decoder accepts
    const auto size = static_cast<std::int32_t>(random() >> 5 & ((1u << bits) - 1));
    v = random() % 3 == 0 ? 0 : random() % 2 ? size : -size;
  }
  std::vector<std::int32_t> decoded;
  ASSERT_TRUE(slice.decode(slice.encode(), 3, decoded));
  EXPECT_EQ(decoded, slice.values);
}

TEST_P(VectorCoefficientsTest, GivesBackTheLargestValuesEverywhere) {
  CodedSlice slice(GetParam().voxels, {{0, 1}});
  for (std::size_t i = 0; i < slice.values.size(); ++i)
    slice.values[i] = i % 2 ? (1 << 27) - 1 : -(1 << 27) + 1;
  std::vector<std::int32_t> decoded;
  ASSERT_TRUE(slice.decode(slice.encode(), 1, decoded));
  EXPECT_EQ(decoded, slice.values);
}

TEST_P(VectorCoefficientsTest, LowerGroupsDecodeWithoutTheHigher) {
  CodedSlice slice(GetParam().voxels, {{0}, {1, 2}, {3}});
  std::mt19937 random(2);
  for (auto& v : slice.values) v = static_cast<std::int32_t>(random() % 7) - 3;
  const auto units = slice.encode();
  std::vector<std::int32_t> decoded;
  ASSERT_TRUE(slice.decode(units, 2, decoded));
  for (std::size_t i = 0; i < decoded.size(); ++i)
    EXPECT_EQ(decoded[i], i % slice.planes < 9 ? slice.values[i] : 0);
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_2, VectorCoefficientsTest,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_7_2_VectorCoefficients, ZeroSubtreesCostNextToNothing) {
  CodedSlice slice(test::sphere_cloud(6), {{0, 1, 2, 3, 4, 5, 6, 7}});
  std::size_t bytes = 0;
  for (const auto& unit : slice.encode()) bytes += unit.size();
  EXPECT_LT(bytes, slice.tree.size() / 200);  // of thousands of nodes
}

TEST(Spec_8_7_2_VectorCoefficients, AnEndlessPrefixIsRefused) {
  const CodedSlice slice(test::sphere_cloud(4), {{0}});
  const std::vector<std::vector<std::uint8_t>> ones(2, std::vector<std::uint8_t>(500, 0));
  std::vector<std::int32_t> decoded;
  EXPECT_FALSE(slice.decode(ones, 1, decoded));  // code 0 takes every decision as 1
}

TEST(Spec_8_7_2_VectorCoefficients, GarbageGivesValuesInRangeOrARefusal) {
  CodedSlice slice(test::sphere_cloud(4), {{0}, {1, 2}});
  std::mt19937 random(3);
  std::vector<std::int32_t> decoded;
  for (std::size_t i = 0; i < 50; ++i) {
    std::vector<std::vector<std::uint8_t>> units(4, std::vector<std::uint8_t>(i * 7));
    for (auto& unit : units)
      for (auto& byte : unit) byte = static_cast<std::uint8_t>(random());
    slice.decode(units, 2, decoded);  // sanitizers watch
    for (const std::int32_t v : decoded) ASSERT_LT(std::abs(std::int64_t{v}), 1 << 29);
  }
}

}  // namespace
}  // namespace slf::vector_coefficients_test
