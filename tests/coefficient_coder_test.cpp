#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <random>

#include "attributes/coefficient_decoder.h"
#include "attributes/vector_coefficients.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "tests/field_support.h"

namespace slf {
namespace {

std::vector<std::uint32_t> one_row_a_point(std::size_t points) {
  std::vector<std::uint32_t> first(points + 1);
  std::iota(first.begin(), first.end(), 0u);
  return first;
}

class CoefficientNeighboursTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(CoefficientNeighboursTest, FacesAreTheMergesOfTheCellsBeside) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto around = find_coefficient_neighbours(tree, morton_codes, one_row_a_point(tree.size()));
  std::map<std::pair<int, Voxel>, std::uint32_t> row_at;  // by split and corner of the cell
  const auto cell = [&](std::uint32_t row) {
    return from_morton(morton_codes[row] & ~std::uint64_t{0} << tree.split[row] << 1);
  };
  for (std::uint32_t row = 1; row < tree.size(); ++row) row_at[{tree.split[row], cell(row)}] = row;
  for (std::uint32_t row = 1; row < tree.size(); ++row)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Voxel beside = cell(row);
      int size = 0;  // bits of the axis within the cell
      while (3 * size + static_cast<int>(axis) <= tree.split[row]) ++size;
      beside[axis] -= 1 << size;
      const auto found = row_at.find({tree.split[row], beside});
      EXPECT_EQ(around.faces[row][axis], found == row_at.end() ? 0 : found->second);
      EXPECT_LT(around.faces[row][axis], row);  // coded before
    }
}

TEST_P(CoefficientNeighboursTest, ScaleIsTheCoefficientOfAUnitDifference) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto around = find_coefficient_neighbours(tree, morton_codes, one_row_a_point(tree.size()));
  std::vector<std::uint32_t> weight(tree.size(), 1);
  EXPECT_EQ(around.scale[0], 256u);
  for (std::size_t i = tree.merges.size(); i-- > 0;) {
    const Merge& m = tree.merges[i];
    const double l = weight[m.left], r = weight[m.right];
    EXPECT_NEAR(around.scale[m.right], 256 * std::sqrt(l * r / (l + r)), 1);
    weight[m.left] += weight[m.right];
  }
}

TEST_P(CoefficientNeighboursTest, OfTheKeptLevelsAreThoseOfTheWholeTree) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto whole = find_coefficient_neighbours(tree, morton_codes, one_row_a_point(tree.size()));
  const RahtTop top = build_raht_top(morton_codes, 6);
  const auto kept = find_coefficient_neighbours(top.tree, morton_codes, top.first);
  for (std::size_t row = 0; row < top.tree.size(); ++row) {
    EXPECT_EQ(kept.scale[row], whole.scale[top.first[row]]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(top.first[kept.faces[row][axis]], whole.faces[top.first[row]][axis]);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_2, CoefficientNeighboursTest,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

/// Coefficients of a slice in groups and two ranges, and how they are coded.
struct CodedSlice {
  explicit CodedSlice(const std::vector<Voxel>& voxels, std::vector<std::vector<std::uint16_t>> f)
      : tree(build_raht_tree(test::codes(voxels))), groups(std::move(f)) {
    for (const auto& functions : groups) planes += 3 * functions.size();
    neighbours =
        find_coefficient_neighbours(tree, test::codes(voxels), one_row_a_point(tree.size()));
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

TEST(Spec_8_7_1_CoefficientModels, UnitsOfZerosAreEmptyAndLeaveTheStateAlone) {
  const auto voxels = test::sphere_cloud(4);
  const auto morton_codes = test::codes(voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto first = one_row_a_point(tree.size());
  const PlaneGroups groups = {{0}, {1, 2, 3, 4, 5}};
  const std::array<std::size_t, 4> ends = {0, order_end(tree, 6), order_end(tree, 3), tree.size()};
  std::vector<std::int32_t> values(18 * tree.size());
  for (std::size_t i = ends[2]; i < tree.size(); i += 3)  // the finest rows alone, group 1 alone
    values[18 * tree.order[i] + 3 + i % 15] = static_cast<std::int32_t>(i % 5) - 2;
  for (const bool vector : {true, false}) {
    CoefficientModels written(groups, tree, morton_codes, first, vector);
    CoefficientModels read(groups, tree, morton_codes, first, vector);
    std::vector<std::int32_t> decoded(values.size());
    for (std::size_t range = 0; range < 3; ++range)
      for (std::size_t g = 0; g < 2; ++g) {
        RangeEncoder encoder;
        written.code(encoder, {tree, values, 18}, g, ends[range], ends[range + 1]);
        const auto unit = encoder.finish();
        EXPECT_EQ(unit.empty(), range < 2 || g == 0);
        EXPECT_TRUE(decode_coefficients(unit, read, {tree, decoded, 18}, g, ends[range],
                                        ends[range + 1], false));
      }
    EXPECT_EQ(decoded, values);
  }
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
}  // namespace slf
