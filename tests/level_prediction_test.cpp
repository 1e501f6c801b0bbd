// Children predicted from coarser levels: exact, bounded, switchable. Spec 8.7.6.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

#include "attributes/coefficient_quantiser.h"
#include "attributes/level_prediction.h"
#include "attributes/raht_forward.h"
#include "attributes/raht_inverse.h"
#include "attributes/raht_tree.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/field_support.h"

namespace slf {
namespace {

using Values = std::vector<std::int32_t>;

/// Smooth over space, with a little noise: what prediction is for.
LightField smooth_field(const std::vector<Voxel>& voxels, int bits, int functions) {
  LightField field = test::make_field(voxels, bits, functions);
  std::mt19937 random(3);
  std::size_t i = 0;
  for (const Voxel& v : field.positions)
    for (int j = 0; j < 3 * functions; ++j)
      field.components[i++] =
          static_cast<std::int32_t>(1000 * std::sin((v[0] + (j + 1) * v[1] + 2 * v[2]) * 0.1)) +
          static_cast<std::int32_t>(random() % 21);
  return field;
}

CodingParameters parameters_of(int functions, bool predict) {
  CodingParameters parameters;
  parameters.step.assign(static_cast<std::size_t>(functions), {40, 40, 60});
  for (int k = 0; k < functions; ++k) parameters.group.push_back(k == 0 ? 0 : k % 2 + 1);
  parameters.predict = predict;
  return parameters;
}

std::vector<std::uint8_t> packed(const LightField& field, const CodingParameters& parameters) {
  const auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return stream ? *stream : std::vector<std::uint8_t>{};
}

Values decoded(const std::vector<std::uint8_t>& stream, const DecodeOptions& options = {}) {
  const auto field = decode(stream, options);
  EXPECT_TRUE(field) << to_string(field.error());
  return field ? field->components : Values{};
}

DecodeOptions options_of(int levels, int groups, int threads) {
  DecodeOptions options;
  options.levels = levels;
  options.groups = groups;
  options.threads = threads;
  return options;
}

class LevelPrediction : public testing::TestWithParam<test::NamedCloud> {};

// The digest is of what the encoder's loop reconstructs, so decode fails where the two differ.
TEST_P(LevelPrediction, DecoderAndEncoderReconstructTheSame) {
  const LightField field = smooth_field(GetParam().voxels, GetParam().bits, 18);
  for (const double rdo : {0.0, 1.0})
    for (const std::uint32_t points : {1u << 20, 300u}) {
      CodingParameters parameters = parameters_of(18, true);
      parameters.max_slice_points = points;
      parameters.rdo = rdo;
      const auto stream = packed(field, parameters);
      const Values one = decoded(stream);
      EXPECT_EQ(one, decoded(stream, options_of(0, 0, 3)));
      double square = 0;
      for (std::size_t i = 0; i < one.size(); ++i)
        square += std::pow(one[i] - field.components[i], 2.0);
      EXPECT_LT(std::sqrt(square / static_cast<double>(one.size())), rdo == 0 ? 40 : 80);
      parameters.threads = 5;
      EXPECT_EQ(packed(field, parameters), stream);
    }
}

TEST_P(LevelPrediction, CoarserLevelsNeedNothingOfFinerOnes) {
  const int bits = GetParam().bits;
  if (bits < 2) GTEST_SKIP() << "one level";
  const LightField field = smooth_field(GetParam().voxels, bits, 2);
  CodingParameters parameters = parameters_of(2, true);
  parameters.group = {0, 0};
  parameters.coefficient_level_ends = {bits - 1, bits};
  const auto stream = packed(field, parameters);
  const auto info = read_info(stream);
  ASSERT_TRUE(info);
  const DecodeOptions coarse = options_of(bits - 1, 0, 1);
  for (const UnitInfo& unit : info->units)
    if (unit.type == "coefficients" && unit.level_last == bits - 1) {
      const std::vector<std::uint8_t> cut(
          stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(unit.offset));
      EXPECT_EQ(decoded(cut, coarse), decoded(stream, coarse));
    }
}

TEST_P(LevelPrediction, GroupsDoNotNeedEachOther) {
  const LightField field = smooth_field(GetParam().voxels, GetParam().bits, 6);
  const auto stream = packed(field, parameters_of(6, true));
  const Values all = decoded(stream), first = decoded(stream, options_of(0, 2, 1));
  Values expected;  // of functions 0, 2, 4
  for (std::size_t i = 0; i < all.size(); ++i)
    if (i / 3 % 2 == 0) expected.push_back(all[i]);
  EXPECT_EQ(first, expected);
}

// Spec 8.8.2; UBSan watches. Every plane has modes of its own on every level.
TEST_P(LevelPrediction, TheLargestCoefficientsStayInBounds) {
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

// Spec 8.2.1: from a level on, everything is as without what is above.
TEST_P(LevelPrediction, FromTheCellsOnIsTheSameAsFromTheRoot) {
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

// Spec 8.2.1, 8.8.2; UBSan watches. A base of a scene of 2^24 points.
TEST_P(LevelPrediction, TheLargestWeightsAndCoefficientsStayInBounds) {
  const auto codes = test::codes(GetParam().voxels);
  const RahtTree tree = build_raht_tree(codes);
  const auto weight = static_cast<std::uint32_t>(
      std::min((std::size_t{1} << 24) / codes.size(), std::size_t{1} << 22));
  constexpr std::size_t kPlanes = 50;
  const std::vector<std::uint32_t> steps(kPlanes, 1);
  std::mt19937 random(11);
  Values values(tree.size() * kPlanes);
  for (auto& v : values) v = random() % 2 ? (1 << 27) - 1 : 1 - (1 << 27);
  TransformLevels levels(codes, GetParam().bits, 0, 0, weight);
  ASSERT_TRUE(raht_inverse_predicted(tree, levels, planes_of_any_mode(kPlanes, 0, GetParam().bits),
                                     steps, values, 1));
}

TEST_P(LevelPrediction, WeightsOfABaseMoveNoCentre) {
  const auto codes = test::codes(GetParam().voxels);
  TransformLevels one(codes, GetParam().bits, 0), many(codes, GetParam().bits, 0, 0, 300);
  for (int l = 0; l < one.count(); ++l) {
    const auto a = one.next().child_places, b = many.next().child_places;
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(a[n].centre, b[n].centre);
      EXPECT_EQ(300 * a[n].weight, b[n].weight);
    }
  }
}

/// What an encoder makes of a part of a scene, and what a decoder makes of that.
struct CodedPart {
  RahtTree tree;
  Values coefficients;
  Quantised quantised;
};

Values decoded_part(const CodedPart& part, TransformLevels levels, const PlaneGroups& groups,
                    const std::vector<std::uint32_t>& steps, Values values, std::size_t cells) {
  std::vector<PredictedPlanes> planes;
  for (std::size_t g = 0; g < groups.size(); ++g)
    planes.push_back({3 * g, 3 * g + 3, part.quantised.modes[g]});
  EXPECT_TRUE(
      raht_inverse_predicted(part.tree, levels, planes, steps, values, 1, {}, kAllPlanes, cells));
  return values;
}

TEST_P(LevelPrediction, BaseAndSlicesReconstructWhatTheEncoderDid) {
  const int bits = GetParam().bits, level = (bits + 1) / 2;
  if (bits < 2) GTEST_SKIP() << "one level";
  const auto codes = test::codes(GetParam().voxels);
  const PlaneGroups groups = {{0}, {1}};
  const std::vector<std::uint32_t> steps(6, 12);
  auto base_codes = test::cells_of(codes, bits - level);
  for (auto& code : base_codes) code <<= 3 * (bits - level);
  const auto weight = static_cast<std::uint32_t>(codes.size() / base_codes.size());
  const Values components = smooth_field(GetParam().voxels, bits, 2).components;
  for (const double rdo : {0.0, 1.0}) {
    CodedPart base{build_raht_tree(base_codes), Values(base_codes.size() * 6), {}};
    std::vector<CodedPart> parts;
    std::vector<SliceCells> cells;
    const auto slices = test::slices_of(codes, bits - level, 2);
    std::size_t begin = 0;
    for (const auto& slice : slices) {
      const std::size_t end = begin + slice.points.size() * 6;
      parts.push_back({build_raht_tree(slice.points),
                       Values(components.begin() + static_cast<std::ptrdiff_t>(begin),
                              components.begin() + static_cast<std::ptrdiff_t>(end)),
                       {}});
      begin = end;
      std::vector<std::uint32_t> first(slice.points.size() + 1);
      std::iota(first.begin(), first.end(), 0u);
      cells.push_back(find_cells(parts.back().tree, first, 3 * (bits - level), slice.first_cell));
      raht_forward(parts.back().tree, 6, parts.back().coefficients, 1, cells.back().size());
      put_into_base(cells.back(), parts.back().coefficients, weight, 6, base.coefficients);
    }
    raht_forward(base.tree, 6, base.coefficients, 1);
    base.quantised = quantise_coefficients(
        {base.tree, base_codes, bits, groups, steps, true, rdo, bits - level, weight, nullptr},
        base.coefficients, 1);
    const Values base_values =
        decoded_part(base, TransformLevels(base_codes, bits, bits - level, 0, weight), groups,
                     steps, base.coefficients, 0);
    EXPECT_EQ(base_values, base.quantised.values);
    for (std::size_t s = 0; s < slices.size(); ++s) {
      const QuantisedBase start{cells[s], level, weight, base.coefficients, base.quantised};
      parts[s].quantised = quantise_coefficients(
          {parts[s].tree, slices[s].points, bits, groups, steps, true, rdo, 0, 1, &start},
          parts[s].coefficients, 2);
      Values values = parts[s].coefficients;
      start_from_base(cells[s], base_values, weight, 6, values);
      EXPECT_EQ(decoded_part(parts[s], TransformLevels(slices[s].points, bits, 0, level), groups,
                             steps, values, cells[s].size()),
                parts[s].quantised.values);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_6, LevelPrediction,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

// The heaviest cells there can be: four of 2^22 points. UBSan watches.
TEST(Spec_8_8_2_Bounds, TheHeaviestCellsOfABaseDoNotOverflow) {
  const std::vector<std::uint64_t> codes = {0, 1, 2, 4 * 8 + 7};
  const RahtTree tree = build_raht_tree(codes);
  for (const PredictionMode mode : {kWide, kSharpDamped, kSharp})
    for (const std::int32_t sign : {1, -1}) {
      Values values = {sign * ((1 << 27) - 1), -sign * ((1 << 27) - 1), sign * ((1 << 27) - 1),
                       -sign * ((1 << 27) - 1)};
      TransformLevels levels(codes, 2, 0, 0, 1u << 22);
      const std::vector<PredictedPlanes> planes = {{0, 1, {mode, mode}}};
      ASSERT_TRUE(
          raht_inverse_predicted(tree, levels, planes, std::vector<std::uint32_t>{1}, values, 1));
      for (const auto v : values) EXPECT_LE(std::abs(v), kPredictedLimit);
    }
}

TEST(Spec_8_7_6_Encoder, PredictsASmoothGroupAndLeavesANoisyOneAlone) {
  LightField field = smooth_field(test::sphere_cloud(6), 6, 2);
  std::mt19937 random(4);
  for (std::size_t i = 0; i < field.components.size(); ++i)
    if (i / 3 % 2 == 1) field.components[i] = static_cast<std::int32_t>(random() % 2001) - 1000;
  CodingParameters parameters = parameters_of(2, true);
  parameters.group = {0, 1};
  parameters.base_levels = 0;
  const auto on = packed(field, parameters);
  parameters.predict = false;
  EXPECT_LT(on.size(), packed(field, parameters).size());
  const auto info = read_info(on);
  ASSERT_TRUE(info);
  for (const UnitInfo& unit : info->units) {
    if (unit.type != "coefficients") continue;
    ASSERT_EQ(unit.prediction.size(), 6u);
    EXPECT_EQ(unit.prediction.back() != 0, unit.group == 0);
  }
}

TEST(Spec_7_2_Prediction, IsNotPartOfAStreamWithoutTheFlag) {
  CodingParameters parameters = parameters_of(2, false);
  parameters.group = {0, 0};
  const auto info = read_info(packed(smooth_field(test::sphere_cloud(4), 4, 2), parameters));
  ASSERT_TRUE(info);
  for (const UnitInfo& unit : info->units) EXPECT_TRUE(unit.prediction.empty());
}

}  // namespace
}  // namespace slf
