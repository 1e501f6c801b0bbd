// SPDX-License-Identifier: Apache-2.0
// Rows around a row, and scales: what contexts of coefficients are made of. Spec 8.7.2.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "attributes/coefficient_neighbours.h"
#include "tests/codec/field_support.h"

namespace slf::coefficient_neighbours_test {
namespace {

using test::one_row_a_point;

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
      const std::uint32_t face = around.rows[around.place[row]].faces[axis];
      EXPECT_EQ(tree.order[face], found == row_at.end() ? 0 : found->second);
      EXPECT_LT(face, around.place[row]);  // coded before
    }
}

TEST_P(CoefficientNeighboursTest, ScaleIsTheCoefficientOfAUnitDifference) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto around = find_coefficient_neighbours(tree, morton_codes, one_row_a_point(tree.size()));
  std::vector<std::uint32_t> weight(tree.size(), 1);
  EXPECT_EQ(around.rows[0].scale, 256u);
  for (std::size_t i = tree.merges.size(); i-- > 0;) {
    const Merge& m = tree.merges[i];
    const double l = weight[m.left], r = weight[m.right];
    EXPECT_NEAR(around.rows[around.place[m.right]].scale, 256 * std::sqrt(l * r / (l + r)), 1);
    weight[m.left] += weight[m.right];
  }
}

TEST_P(CoefficientNeighboursTest, KeptLevelsHaveThoseOfTheWholeTree) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto whole = find_coefficient_neighbours(tree, morton_codes, one_row_a_point(tree.size()));
  const RahtTop top = build_raht_top(morton_codes, 6);
  const auto kept = find_coefficient_neighbours(top.tree, morton_codes, top.first);
  for (std::size_t row = 0; row < top.tree.size(); ++row) {
    const auto& of_kept = kept.rows[kept.place[row]];
    const auto& of_whole = whole.rows[whole.place[top.first[row]]];
    EXPECT_EQ(of_kept.scale, of_whole.scale);
    for (std::size_t axis = 0; axis < 3; ++axis)
      EXPECT_EQ(top.first[top.tree.order[of_kept.faces[axis]]], tree.order[of_whole.faces[axis]]);
  }
}

TEST_P(CoefficientNeighboursTest, TheHeaviestCellsOfABaseScaleByTheRootOfTheirWeight) {
  const auto morton_codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(morton_codes);
  const auto first = one_row_a_point(tree.size());
  const auto weight = static_cast<std::uint32_t>(
      std::min((std::size_t{1} << 24) / tree.size(), std::size_t{1} << 22));
  const auto one = find_coefficient_neighbours(tree, morton_codes, first);
  const auto before = test::weights_alike(tree.size(), weight);
  const auto many = find_coefficient_neighbours(tree, morton_codes, first, CodeWeights(before));
  EXPECT_EQ(many.rows[0].scale, 256u);
  for (std::size_t place = 1; place < tree.size(); ++place) {
    EXPECT_EQ(many.rows[place].faces, one.rows[place].faces);
    EXPECT_NEAR(many.rows[place].scale / (one.rows[place].scale * std::sqrt(weight)), 1, 0.006);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_2, CoefficientNeighboursTest,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

}  // namespace
}  // namespace slf::coefficient_neighbours_test
