#include <gtest/gtest.h>

#include <cmath>
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

TEST_P(CoefficientNeighboursTest, OfTheKeptLevelsAreThoseOfTheWholeTree) {
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
  const auto many = find_coefficient_neighbours(tree, morton_codes, first, weight);
  EXPECT_EQ(many.rows[0].scale, 256u);
  for (std::size_t place = 1; place < tree.size(); ++place) {
    EXPECT_EQ(many.rows[place].faces, one.rows[place].faces);
    EXPECT_NEAR(many.rows[place].scale / (one.rows[place].scale * std::sqrt(weight)), 1, 0.006);
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
TEST(Spec_8_2_1_CoefficientModels, ASliceOfAllCellsCostsWhatTheWholeTreeDoes) {
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
  for (const std::uint32_t row : in_slice.row)
    base_values.insert(base_values.end(), values.begin() + 21 * row,
                       values.begin() + 21 * row + 21);
  for (const bool vector : {true, false}) {
    CoefficientModels whole(groups, tree, points, first, vector),
        base(groups, base_tree, cells, one_row_a_point(cells.size()), vector, 64),
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

TEST(Spec_8_2_1_CoefficientModels, SlicesDecodeFromTheBaseOrFromTheFirstSlice) {
  const int bits = 6, level = 3, below = 3 * (bits - level);
  const auto points = test::codes(test::sphere_cloud(bits));
  auto cells = test::cells_of(points, bits - level);
  for (auto& code : cells) code <<= below;
  const RahtTree base_tree = build_raht_tree(cells);
  const PlaneGroups groups = {{0}, {1, 2, 3, 4, 5, 6}};
  auto base_values = sparse_values(base_tree.size() * 21, 6);
  const auto base_first = one_row_a_point(cells.size());
  for (const bool vector : {true, false}) {
    CoefficientModels written(groups, base_tree, cells, base_first, vector, 20),
        read(groups, base_tree, cells, base_first, vector, 20);
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

TEST(Spec_8_2_1_CoefficientModels, StatesGivenAwayDoNotMoveOn) {
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
