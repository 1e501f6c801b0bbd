// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cstdlib>

#include "bitstream/units.h"
#include "codec/encoder/pack_frame.h"
#include "field_support.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/given_planes.h"

namespace slf::codec_round_trip_test {
namespace {

using test::NamedCloud;

class CodecRoundTrip : public testing::TestWithParam<NamedCloud> {};

std::vector<std::uint8_t> packed(const LightField& field, const CodingParameters& parameters) {
  auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return stream ? *stream : std::vector<std::uint8_t>{};
}

CodingParameters with_step(int functions, std::uint32_t step) {
  CodingParameters parameters;
  parameters.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  return parameters;
}

TEST_P(CodecRoundTrip, GeometryAloneIsLossless) {
  const LightField field = test::make_field(GetParam().voxels, GetParam().bits, 0);
  const auto decoded = decode(packed(field, {}));
  ASSERT_TRUE(decoded) << to_string(decoded.error());
  EXPECT_EQ(decoded->positions, field.positions);
  EXPECT_FALSE(decoded->partial);
}

TEST_P(CodecRoundTrip, ComponentsAreWithinTheStepOfBothCoders) {
  for (const auto coder : {CoefficientCoder::kVector, CoefficientCoder::kIndependent}) {
    const LightField field = test::make_field(GetParam().voxels, GetParam().bits, 4);
    CodingParameters parameters = with_step(4, 1);
    parameters.coefficients = coder;
    parameters.group = {0, 1, 1, 2};
    const auto decoded = decode(packed(field, parameters));
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    ASSERT_EQ(decoded->components.size(), field.components.size());
    // Step 1: every merge rounds twice, each level adds a little.
    int largest = 0;
    for (std::size_t i = 0; i < field.components.size(); ++i)
      largest = std::max(largest, std::abs(decoded->components[i] - field.components[i]));
    EXPECT_LE(largest, 4);
  }
}

TEST_P(CodecRoundTrip, BytesDoNotDependOnThreads) {
  const LightField field = test::make_field(GetParam().voxels, GetParam().bits, 40);
  CodingParameters parameters = with_step(40, 16);
  parameters.max_slice_points = 300;  // several slices
  parameters.threads = 1;
  const auto one = packed(field, parameters);
  for (const int threads : {2, 7}) {
    parameters.threads = threads;
    EXPECT_EQ(packed(field, parameters), one);
    DecodeOptions options;
    options.threads = threads;
    const auto decoded = decode(one, options), alone = decode(one);
    ASSERT_TRUE(decoded && alone);
    EXPECT_EQ(decoded->components, alone->components);
  }
}

TEST_P(CodecRoundTrip, PointsMayComeInAnyOrder) {
  LightField field = test::make_field(GetParam().voxels, GetParam().bits, 2);
  const auto sorted = packed(field, with_step(2, 4));
  std::reverse(field.positions.begin(), field.positions.end());
  std::vector<std::int32_t> reversed;
  for (std::size_t p = field.num_points(); p-- > 0;)
    reversed.insert(reversed.end(), field.components.begin() + static_cast<std::ptrdiff_t>(6 * p),
                    field.components.begin() + static_cast<std::ptrdiff_t>(6 * p + 6));
  field.components = reversed;
  EXPECT_EQ(packed(field, with_step(2, 4)), sorted);
  EXPECT_EQ(*pack_taken(field, with_step(2, 4)), sorted);
}

INSTANTIATE_TEST_SUITE_P(Spec_8, CodecRoundTrip, testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_10_Normals, AreLossless) {
  LightField field = test::make_field(test::sphere_cloud(5), 5, 1);
  field.normals.bits = 8;
  for (std::size_t p = 0; p < field.num_points(); ++p)
    field.normals.octahedral.push_back(
        {static_cast<std::uint16_t>(p * 7 % 256), static_cast<std::uint16_t>(p % 256)});
  const auto decoded = decode(packed(field, with_step(1, 8)));
  ASSERT_TRUE(decoded) << to_string(decoded.error());
  EXPECT_EQ(decoded->normals.octahedral, field.normals.octahedral);
}

TEST(Spec_8_5_Draco, PositionsComeBackInMortonOrder) {
  const LightField field = test::make_field(test::sphere_cloud(6), 6, 2);
  CodingParameters parameters = with_step(2, 8);
  parameters.geometry = GeometryCoder::kDraco;
  const auto stream = pack(field, parameters);
  if (!stream && stream.error().code == Errc::kUnsupported) GTEST_SKIP() << "built without Draco";
  ASSERT_TRUE(stream) << stream.error().message;
  const auto decoded = decode(*stream);
  ASSERT_TRUE(decoded) << to_string(decoded.error());
  EXPECT_EQ(decoded->positions, field.positions);
  parameters.geometry = GeometryCoder::kOctree;
  parameters.base_levels = 0;
  EXPECT_EQ(decode(packed(field, parameters))->components, decoded->components);
}

TEST(Spec_8_2_Levels, FewerLevelsGiveTheMeansOfTheNodes) {
  const LightField field = test::make_field(test::sphere_cloud(6), 6, 1);
  CodingParameters parameters = with_step(1, 1);
  parameters.coefficient_level_ends = {4, 6};
  const auto stream = packed(field, parameters);
  for (const int levels : {1, 3, 4, 5, 6}) {
    DecodeOptions options;
    options.levels = levels;
    const auto coarse = decode(stream, options);
    ASSERT_TRUE(coarse) << to_string(coarse.error());
    // The expected means, by brute force.
    std::vector<Voxel> nodes;
    std::vector<double> sum, weight;
    for (std::size_t p = 0; p < field.num_points(); ++p) {
      Voxel node = field.positions[p];
      for (auto& c : node) c >>= 6 - levels;
      if (nodes.empty() || nodes.back() != node) {
        nodes.push_back(node);
        sum.push_back(0);
        weight.push_back(0);
      }
      sum.back() += field.components[3 * p];
      weight.back() += 1;
    }
    ASSERT_EQ(coarse->positions, nodes);
    EXPECT_EQ(coarse->header.grid.bits, levels);
    EXPECT_DOUBLE_EQ(coarse->header.grid.step, 1 << (6 - levels));
    for (std::size_t n = 0; n < nodes.size(); ++n)
      EXPECT_NEAR(coarse->components[3 * n], sum[n] / weight[n], 3)
          << "node " << n << ", levels " << levels;
  }
}

TEST(Spec_8_9_Groups, OnlyThoseAskedForAreGivenOut) {
  const LightField field = test::make_field(test::sphere_cloud(5), 5, 4);
  CodingParameters parameters = with_step(4, 2);
  parameters.group = {0, 1, 1, 2};
  const auto stream = packed(field, parameters);
  const auto whole = decode(stream);
  DecodeOptions options;
  options.groups = 2;
  const auto fewer = decode(stream, options);
  ASSERT_TRUE(whole && fewer);
  EXPECT_TRUE(fewer->partial);
  EXPECT_EQ(fewer->header.coded, (std::vector<std::uint16_t>{0, 1, 2}));
  ASSERT_EQ(fewer->components.size(), whole->components.size() / 4 * 3);
  const std::vector<std::int32_t> planes = given_planes(*fewer);
  for (std::size_t i = 0; i < whole->components.size(); ++i)
    EXPECT_EQ(planes[i], i / 3 % 4 == 3 ? 0 : whole->components[i]);
}

/// The stream with what units of a type hold made senseless, those for which wrong(unit) is true.
template <class Wrong>
std::vector<std::uint8_t> with_wrong_units(const std::vector<std::uint8_t>& stream, Wrong wrong) {
  const Units units = *split_units(stream);
  const StreamInfo info = *read_info(stream);
  std::vector<std::uint8_t> changed(kSignature.begin(), kSignature.end());
  for (std::size_t i = 0; i < units.units.size(); ++i) {
    std::vector<std::uint8_t> payload(units.units[i].payload.begin(), units.units[i].payload.end());
    if (wrong(info.units[i]))
      for (std::size_t at = payload.size() / 2; at < payload.size(); ++at) payload[at] ^= 0xA5;
    append_unit(changed, units.units[i].type, payload);
  }
  return changed;
}

TEST(Spec_8_9_Parts, UnitsOfLevelsAndGroupsThatAreNotAskedForAreNotOpened) {
  const LightField field = test::make_field(test::sphere_cloud(6), 6, 4);
  CodingParameters parameters = with_step(4, 8);
  parameters.group = {0, 1, 1, 2};
  parameters.coefficient_level_ends = {4, 5, 6};
  parameters.index = false;
  const auto stream = packed(field, parameters);
  const auto wrong = with_wrong_units(stream, [](const UnitInfo& unit) {
    return unit.type == "coefficients" && (unit.level_first >= 4 || unit.group == 2);
  });
  EXPECT_FALSE(decode(wrong));
  for (const int levels : {2, 4}) {
    DecodeOptions options;
    options.levels = levels;
    options.groups = 2;
    const auto part = decode(wrong, options), same = decode(stream, options);
    ASSERT_TRUE(part && same) << to_string(part.error());
    EXPECT_EQ(part->components, same->components);
    EXPECT_EQ(part->num_planes(), 9);
  }
}

TEST(Spec_8_9_Parts, PositionsAloneNeedNoFinerGeometry) {
  LightField field = test::make_field(test::sphere_cloud(6), 6, 0);
  CodingParameters parameters;
  parameters.geometry_level_ends = {3, 4, 6};
  parameters.max_slice_points = 1500;
  parameters.index = false;
  const auto stream = packed(field, parameters);
  const auto wrong = with_wrong_units(stream, [](const UnitInfo& unit) {
    return unit.type == "geometry" && unit.level_first >= 4;
  });
  EXPECT_FALSE(decode(wrong));
  for (int levels = 1; levels <= 4; ++levels) {
    DecodeOptions options;
    options.levels = levels;
    const auto part = decode(wrong, options);
    ASSERT_TRUE(part) << to_string(part.error());
    std::vector<Voxel> expected;
    for (Voxel v : field.positions) {
      for (auto& x : v) x >>= 6 - levels;
      if (expected.empty() || expected.back() != v) expected.push_back(v);
    }
    EXPECT_EQ(part->positions, expected);
  }
}

TEST(Spec_7_1_Prefix, EveryCutAtAUnitBoundaryDecodesAndIsPartial) {
  LightField field = test::make_field(test::sphere_cloud(6), 6, 4);
  field.normals.bits = 6;
  field.normals.octahedral.assign(field.num_points(), {3, 60});
  CodingParameters parameters = with_step(4, 8);
  parameters.group = {0, 1, 1, 2};
  parameters.geometry_level_ends = {2, 4, 6};
  parameters.coefficient_level_ends = {3, 6};
  parameters.max_slice_points = 2000;
  const auto stream = packed(field, parameters);
  const auto info = read_info(stream);
  ASSERT_TRUE(info) << to_string(info.error());
  EXPECT_GT(info->num_slices, 1u);
  EXPECT_EQ(info->num_points, field.num_points());
  for (const UnitInfo& unit : info->units) {
    const auto size = static_cast<std::size_t>(unit.offset);
    if (size == 8) continue;  // no unit at all
    const std::vector<std::uint8_t> cut(stream.begin(),
                                        stream.begin() + static_cast<std::ptrdiff_t>(size));
    const auto decoded = decode(cut);
    ASSERT_TRUE(decoded) << "cut at " << size << ": " << to_string(decoded.error());
    EXPECT_TRUE(decoded->partial);
    DecodeOptions options;
    options.max_bytes = size;
    EXPECT_EQ(decode(stream, options)->components, decoded->components);
  }
}

TEST(Pack, WhatItWritesDecodesAtTheLargestCoefficients) {
  // Rounding to a step may not pass the limit of 2^27.
  LightField field =
      test::make_field(test::sorted_distinct({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}), 1, 1);
  for (auto& c : field.components) c = 44000000;
  const auto decoded = decode(packed(field, with_step(1, 70000000)));
  EXPECT_TRUE(decoded) << to_string(decoded.error());
}

TEST(Pack, RefusesDuplicatePositions) {
  LightField field = test::make_field({{1, 2, 3}, {4, 5, 6}, {1, 2, 3}}, 3, 0);
  const auto stream = pack(field, {});
  ASSERT_FALSE(stream);
  EXPECT_EQ(stream.error().code, Errc::kInvalidArgument);
}

TEST(Pack, RefusesWhatIsOutsideItsRanges) {
  const LightField good = test::make_field({{1, 2, 3}}, 3, 1);
  ASSERT_TRUE(pack(good, {}));
  const auto refused = [&](auto change) {
    LightField field = good;
    CodingParameters parameters;
    change(field, parameters);
    return !pack(field, parameters);
  };
  using P = CodingParameters;
  EXPECT_TRUE(refused([](LightField& f, P&) { f.positions[0][0] = 8; }));
  EXPECT_TRUE(refused([](LightField& f, P&) { f.positions[0][0] = -1; }));
  EXPECT_TRUE(refused([](LightField& f, P&) {
    f.positions.clear();
    f.components.clear();
  }));
  EXPECT_TRUE(refused([](LightField& f, P&) { f.components.push_back(0); }));
  EXPECT_TRUE(refused([](LightField& f, P&) { f.components[0] = 1 << 27; }));
  EXPECT_TRUE(refused([](LightField& f, P&) { f.header.grid.step = 0; }));
  EXPECT_TRUE(refused([](LightField& f, P&) { f.header.grid.bits = 22; }));
  EXPECT_TRUE(refused([](LightField&, P& p) { p.step = {{0, 1, 1}}; }));
  EXPECT_TRUE(refused([](LightField&, P& p) { p.group = {1}; }));
  EXPECT_TRUE(refused([](LightField&, P& p) { p.coefficient_level_ends = {2, 2, 3}; }));
  EXPECT_TRUE(refused([](LightField&, P& p) { p.coefficient_level_ends = {2}; }));
}

}  // namespace
}  // namespace slf::codec_round_trip_test
