// SPDX-License-Identifier: Apache-2.0
// Planes as pictures: the way through pack and decode. Spec 8.11.
#include <cstdlib>

#include "bitstream/units.h"
#include "texture_support.h"

namespace slf::texture_test {
namespace {

using namespace test;

class TextureRoundTrip : public testing::TestWithParam<NamedCloud> {};

TEST_P(TextureRoundTrip, LosslessPicturesAndStep1GiveBackTheIntegers) {
  SKIP_WITHOUT_HEVC();
  const LightField field = test::make_field(GetParam().voxels, GetParam().bits, 3);
  for (const auto mode : {TextureSettings::kIntra, TextureSettings::kLowDelay}) {
    CodingParameters parameters = texture_coding(3, 1, 10, true);
    parameters.group = {0, 1, 1};
    parameters.texture.mode = mode;
    const auto decoded = decode(packed(field, parameters));
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(decoded->components, field.components);
    EXPECT_FALSE(decoded->partial);
  }
}

TEST_P(TextureRoundTrip, BytesDoNotDependOnThreads) {
  SKIP_WITHOUT_HEVC();
  const LightField field = test::make_field(GetParam().voxels, GetParam().bits, 4);
  CodingParameters parameters = texture_coding(4, 4, 8, false);
  parameters.group = {0, 1, 1, 2};
  parameters.threads = 1;
  const auto one = packed(field, parameters);
  parameters.threads = 5;
  EXPECT_EQ(packed(field, parameters), one);
  DecodeOptions options;
  options.threads = 5;
  const auto decoded = decode(one, options), alone = decode(one);
  ASSERT_TRUE(decoded && alone);
  EXPECT_EQ(decoded->components, alone->components);
}

INSTANTIATE_TEST_SUITE_P(Spec_8_11, TextureRoundTrip,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_11_6_Values, EverySampleSizeKeepsWithinHalfAStepPlusTheLossOfHevc) {
  SKIP_WITHOUT_HEVC();
  const LightField field = test::make_field(test::sphere_cloud(6), 6, 2, 4000);
  for (const auto& [bits, step] : {std::pair{8, 16u}, {10, 4u}, {12, 1u}}) {
    const auto decoded = decode(packed(field, texture_coding(2, step, bits, true)));
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    for (std::size_t i = 0; i < field.components.size(); ++i)
      EXPECT_LE(std::abs(decoded->components[i] - field.components[i]),
                static_cast<std::int32_t>(step / 2));
  }
}

TEST(Spec_8_11_6_Values, ConstantPlanesHaveNoPictureAndNeedNoVideoCoder) {
  LightField field = test::make_field(test::sphere_cloud(5), 5, 2);
  for (std::size_t i = 0; i < field.components.size(); ++i)
    field.components[i] = 1000 - 700 * static_cast<std::int32_t>(i % 6);
  const auto stream = packed(field, texture_coding(2, 1, 8, false));
  const auto decoded = decode(stream);
  ASSERT_TRUE(decoded) << to_string(decoded.error());
  EXPECT_EQ(decoded->components, field.components);
  const auto info = read_info(stream);
  EXPECT_EQ(info->coefficient_coder, "texture");
  EXPECT_EQ(info->texture_bits, 8);
  EXPECT_EQ(info->profile, 2);
}

TEST(Spec_8_11_6_Values, FewerLevelsGiveTheMeansOfThePoints) {
  SKIP_WITHOUT_HEVC();
  const LightField field = test::make_field(test::sphere_cloud(5), 5, 2);
  const auto stream = packed(field, texture_coding(2, 1, 10, true));
  for (const int levels : {1, 3, 4}) {
    DecodeOptions options;
    options.levels = levels;
    const auto coarse = decode(stream, options);
    ASSERT_TRUE(coarse) << to_string(coarse.error());
    for (std::size_t node = 0, p = 0; node < coarse->num_points(); ++node) {
      std::array<std::int64_t, 6> sum{};
      std::int64_t count = 0;
      for (; p < field.num_points(); ++p, ++count) {
        Voxel cell = field.positions[p];
        for (auto& c : cell) c >>= 5 - levels;
        if (cell != coarse->positions[node]) break;
        for (std::size_t j = 0; j < 6; ++j) sum[j] += field.components[6 * p + j];
      }
      for (std::size_t j = 0; j < 6; ++j) {
        const std::int64_t nearest = (2 * std::abs(sum[j]) + count) / (2 * count);
        EXPECT_EQ(coarse->components[6 * node + j], sum[j] < 0 ? -nearest : nearest);
      }
    }
  }
}

TEST(Spec_8_9_Partial, GroupsLeftOutAreNotThereAndThoseCutOffAreZero) {
  SKIP_WITHOUT_HEVC();
  const LightField field = test::make_field(test::sphere_cloud(5), 5, 2);
  CodingParameters parameters = texture_coding(2, 1, 10, true);
  parameters.group = {0, 1};
  parameters.geometry_level_ends = {4, 5};
  const auto stream = packed(field, parameters);
  DecodeOptions options;
  options.groups = 1;
  const auto first = decode(stream, options);
  ASSERT_TRUE(first) << to_string(first.error());
  EXPECT_TRUE(first->partial);
  std::vector<std::int32_t> of_first, and_zeros;
  for (std::size_t i = 0; i < field.components.size(); ++i) {
    if (i % 6 < 3) of_first.push_back(field.components[i]);
    and_zeros.push_back(i % 6 < 3 ? field.components[i] : 0);
  }
  EXPECT_EQ(first->components, of_first);
  const Units units = *split_units(stream);
  std::uint64_t geometry_seen = 0;
  for (const Unit& unit : units.units) {
    DecodeOptions cut;
    cut.max_bytes = unit.offset + unit.bytes;
    const auto decoded = decode(stream, cut);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    geometry_seen += unit.type == UnitType::kGeometry;
    if (unit.type == UnitType::kCoefficients && decoded->components != field.components) {
      EXPECT_EQ(decoded->components, and_zeros);
    }
    if (geometry_seen < 2) {
      EXPECT_EQ(std::count(decoded->components.begin(), decoded->components.end(), 0),
                static_cast<std::ptrdiff_t>(decoded->components.size()));
    }
  }
}

TEST(TextureSteps, TooSmallForTheBitsAreRefusedWithThePlaneAndTheLeastStep) {
  LightField field = test::make_field(test::sphere_cloud(4), 4, 2);
  for (std::size_t i = 0; i < field.components.size(); ++i)
    field.components[i] = i % 6 == 4 ? static_cast<std::int32_t>(i / 6 % 2) * 2551 : 0;
  const auto stream = pack(field, texture_coding(2, 10, 8, false));
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::kInvalidArgument);
  EXPECT_NE(stream.error().message.find("plane 4 of the texture needs at least 11 with 8 bits"),
            std::string::npos)
      << stream.error().message;
}

TEST(TextureParameters, WhatTheProfileHasNotIsRefused) {
  const LightField field = test::make_field(test::sphere_cloud(4), 4, 2);
  CodingParameters parameters = texture_coding(2, 16, 8, false);
  parameters.geometry = GeometryCoder::kDraco;
  EXPECT_EQ(pack(field, parameters).error().code, Errc::kInvalidArgument);
  parameters = texture_coding(2, 16, 9, false);
  EXPECT_EQ(pack(field, parameters).error().code, Errc::kInvalidArgument);
  parameters = texture_coding(2, 16, 8, false);
  parameters.coefficient_level_ends = {2, 4};
  EXPECT_EQ(pack(field, parameters).error().code, Errc::kInvalidArgument);
}

TEST(TextureParameters, GeometryAloneStaysInTheMainProfile) {
  const auto stream =
      packed(test::make_field(test::sphere_cloud(4), 4, 0), texture_coding(0, 1, 8, false));
  EXPECT_EQ(read_info(stream)->profile, 0);
}

}  // namespace
}  // namespace slf::texture_test
