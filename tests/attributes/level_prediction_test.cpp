// SPDX-License-Identifier: Apache-2.0
// Children predicted from coarser levels: a decoder does what the encoder did, and it can be off.
// Spec 8.7.6.
#include <gtest/gtest.h>

#include <random>

#include "level_prediction_support.h"
#include "slf/decoder.h"
#include "slf/encoder.h"

namespace slf::level_prediction_test {
namespace {

using test::smooth_field;
using test::Values;

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

INSTANTIATE_TEST_SUITE_P(Spec_8_7_6, LevelPrediction,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

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
}  // namespace slf::level_prediction_test
