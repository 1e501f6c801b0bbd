// SPDX-License-Identifier: Apache-2.0
// What units of coefficients hand on: nothing where all is zero, from a base, from the first slice.
#include <gtest/gtest.h>

#include <random>

#include "attributes/coefficient_decoder.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "tests/codec/field_support.h"

namespace slf::coefficient_models_test {
namespace {

using test::one_row_a_point;

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

/// Small values in some rows.
std::vector<std::int32_t> sparse_values(std::size_t count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::vector<std::int32_t> values(count);
  for (auto& v : values) v = random() % 4 == 0 ? static_cast<std::int32_t>(random() % 9) - 4 : 0;
  return values;
}

std::vector<std::uint8_t> encode_unit(CoefficientModels& models, const RahtTree& tree,
                                      std::vector<std::int32_t>& values, std::size_t planes,
                                      std::size_t group, std::size_t begin, std::size_t end) {
  RangeEncoder encoder;
  EXPECT_TRUE(models.code(encoder, {tree, values, planes}, group, begin, end));
  return encoder.finish();
}

// Where all cells have as many points as the base says, scales are the same, and so are contexts.
TEST(Spec_8_2_CoefficientModels, ASliceOfAllCellsCostsWhatTheWholeTreeDoes) {
  std::vector<Voxel> voxels;
  for (std::int32_t i = 0; i < 4096; ++i) voxels.push_back({i & 15, i >> 4 & 15, i >> 8});
  const auto points = test::codes(test::sorted_distinct(voxels));
  const int bits = 4, level = 2, below = 3 * (bits - level);
  auto cells = test::cells_of(points, bits - level);
  for (auto& code : cells) code <<= below;
  const RahtTree tree = build_raht_tree(points), base_tree = build_raht_tree(cells);
  const PlaneGroups groups = {{0}, {1, 2, 3, 4, 5, 6}};
  auto values = sparse_values(tree.size() * 21, 5);
  std::vector<std::int32_t> base_values;
  const auto first = one_row_a_point(tree.size());
  const SliceCells in_slice = find_cells(tree, first, below, 0);
  const auto before = test::weights_alike(cells.size(), 64);
  for (const std::uint32_t row : in_slice.row)
    base_values.insert(base_values.end(), values.begin() + 21 * row,
                       values.begin() + 21 * row + 21);
  for (const bool vector : {true, false}) {
    CoefficientModels whole(groups, tree, points, first, vector),
        base(groups, base_tree, cells, one_row_a_point(cells.size()), vector, CodeWeights(before)),
        slice(groups, tree, points, first, vector);
    const std::size_t cut = order_end(tree, below);
    for (std::size_t g = 0; g < 2; ++g)
      EXPECT_EQ(encode_unit(base, base_tree, base_values, 21, g, 0, cells.size()),
                encode_unit(whole, tree, values, 21, g, 0, cut));
    slice.adopt(base, in_slice);
    for (std::size_t g = 0; g < 2; ++g) {
      slice.start_from(g, base.states(g));
      EXPECT_EQ(encode_unit(slice, tree, values, 21, g, cut, tree.size()),
                encode_unit(whole, tree, values, 21, g, cut, tree.size()));
    }
  }
}

TEST(Spec_8_1_CoefficientModels, SlicesDecodeFromTheBaseOrFromTheFirstSlice) {
  const int bits = 6, level = 3, below = 3 * (bits - level);
  const auto points = test::codes(test::sphere_cloud(bits));
  auto cells = test::cells_of(points, bits - level);
  for (auto& code : cells) code <<= below;
  const RahtTree base_tree = build_raht_tree(cells);
  const PlaneGroups groups = {{0}, {1, 2, 3, 4, 5, 6}};
  auto base_values = sparse_values(base_tree.size() * 21, 6);
  const auto base_first = one_row_a_point(cells.size()),
             before = test::weights_by_chance(cells.size(), 8);
  for (const bool vector : {true, false}) {
    CoefficientModels written(groups, base_tree, cells, base_first, vector, CodeWeights(before)),
        read(groups, base_tree, cells, base_first, vector, CodeWeights(before));
    std::vector<std::int32_t> decoded(base_values.size());
    std::vector<CoefficientStates> write_from, read_from;
    for (std::size_t g = 0; g < 2; ++g) {
      const auto unit = encode_unit(written, base_tree, base_values, 21, g, 0, cells.size());
      ASSERT_TRUE(
          decode_coefficients(unit, read, {base_tree, decoded, 21}, g, 0, cells.size(), false));
      write_from.push_back(written.states(g));
      read_from.push_back(read.states(g));
    }
    ASSERT_EQ(decoded, base_values);
    std::uint32_t seed = 7;
    for (const auto& slice : test::slices_of(points, bits - level, 3)) {
      const RahtTree tree = build_raht_tree(slice.points);
      const auto first = one_row_a_point(tree.size());
      const SliceCells own = find_cells(tree, first, below, slice.first_cell);
      auto values = sparse_values(tree.size() * 21, ++seed);
      std::vector<std::int32_t> result = values;
      const std::size_t begin = order_end(tree, below);
      for (std::size_t i = begin; i < tree.size(); ++i)
        std::fill_n(result.begin() + static_cast<std::ptrdiff_t>(tree.order[i] * 21), 21, 0);
      CoefficientModels writer(groups, tree, slice.points, first, vector),
          reader(groups, tree, slice.points, first, vector);
      writer.adopt(written, own);
      reader.adopt(read, own);
      for (std::size_t g = 0; g < 2; ++g) {
        writer.start_from(g, write_from[g]);
        reader.start_from(g, read_from[g]);
        const auto unit = encode_unit(writer, tree, values, 21, g, begin, tree.size());
        ASSERT_TRUE(
            decode_coefficients(unit, reader, {tree, result, 21}, g, begin, tree.size(), false));
        if (slice.first_cell == 0) {  // the others start from this one
          write_from[g] = writer.states(g);
          read_from[g] = reader.states(g);
        }
      }
      EXPECT_EQ(result, values);
    }
  }
}

TEST(Spec_8_1_CoefficientModels, StatesGivenAwayDoNotMoveOn) {
  const auto points = test::codes(test::sphere_cloud(5));
  const RahtTree tree = build_raht_tree(points);
  const auto first = one_row_a_point(points.size());
  const PlaneGroups groups = {{0, 1, 2}};
  auto values = sparse_values(tree.size() * 9, 8);
  for (const bool vector : {true, false}) {
    CoefficientModels models(groups, tree, points, first, vector);
    const std::size_t middle = order_end(tree, 6);
    encode_unit(models, tree, values, 9, 0, 0, middle);
    const CoefficientStates given = models.states(0);
    const auto of_a_copy = [&] {
      CoefficientModels other(groups, tree, points, first, vector);
      other.start_from(0, given);
      return encode_unit(other, tree, values, 9, 0, 0, middle);
    };
    const auto before = of_a_copy();
    encode_unit(models, tree, values, 9, 0, middle, tree.size());
    EXPECT_EQ(of_a_copy(), before);
    CoefficientModels fresh(groups, tree, points, first, vector);
    EXPECT_NE(encode_unit(fresh, tree, values, 9, 0, 0, middle), before);
  }
}

}  // namespace
}  // namespace slf::coefficient_models_test
