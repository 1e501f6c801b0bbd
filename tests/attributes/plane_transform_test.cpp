// SPDX-License-Identifier: Apache-2.0
// Transforms across planes: spec 7.11 and 8.7.5, and what the encoder makes of them.
#include "attributes/plane_transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <span>

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "codec/scene_units.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/given_planes.h"
#include "tests/codec/field_support.h"

namespace slf {

static void PrintTo(TransformMode mode, std::ostream* out) {
  *out << (mode == TransformMode::kJoint ? "joint" : "functions");
}

}  // namespace slf

namespace slf::plane_transform_test {
namespace {

PlaneTransform random_transform(std::size_t functions, std::size_t rank, std::size_t lanes,
                                std::vector<std::uint8_t>& precision) {
  PlaneTransform t;
  for (std::size_t k = 0; k < functions; ++k) t.functions.push_back(static_cast<std::uint16_t>(k));
  t.rank = rank;
  t.lanes = lanes;
  std::mt19937 random(5);
  for (std::size_t c = 0; c < t.columns(); ++c) {
    precision.push_back(static_cast<std::uint8_t>(random() % 15));
    for (std::size_t r = 0; r < t.rows(); ++r) {
      const int shift = PlaneTransform::kFractionBits - precision.back();
      const std::int32_t entry = PlaneTransform::kEntryLimit >> shift >> (random() % 21);
      t.matrix.push_back((random() & 1 ? entry : -entry) * (1 << shift));
    }
  }
  return t;
}

TEST(Spec_7_11_Matrix, IsLosslessAndNoTruncationGivesIt) {
  for (const std::size_t lanes : {1u, 3u}) {
    std::vector<std::uint8_t> precision;
    PlaneTransform t = random_transform(9, 4, lanes, precision);
    RangeEncoder encoder;
    ASSERT_TRUE(code_columns(encoder, t, {0, t.columns()}, precision));
    const auto bytes = encoder.finish();
    PlaneTransform decoded = t;
    decoded.matrix.assign(t.matrix.size(), 0);
    RangeDecoder decoder(bytes);
    ASSERT_TRUE(code_columns(decoder, decoded, {0, t.columns()}, {}));
    EXPECT_TRUE(decoder.finish("cu_matrix"));
    EXPECT_EQ(decoded.matrix, t.matrix);
    for (std::size_t size = 0; size + 4 < bytes.size(); ++size) {
      RangeDecoder cut(std::span<const std::uint8_t>(bytes).first(size));
      const bool sound =
          code_columns(cut, decoded, {0, t.columns()}, {}) && cut.finish("cu_matrix");
      EXPECT_FALSE(sound && decoded.matrix == t.matrix) << size;
    }
  }
}

/// One point of the functions 0 .. functions - 1 with these components.
LightField point_of(int functions, std::vector<std::uint16_t> coded, PlaneTransform t,
                    std::vector<std::int32_t> components) {
  LightField field;
  field.positions = {{0, 0, 0}};
  field.header.num_functions = functions;
  field.header.coded = std::move(coded);
  field.header.transforms = {std::move(t)};
  field.components = std::move(components);
  return field;
}

TEST(Spec_8_7_5_Expansion, IsTheRoundedProductOfChannelsAndMatrix) {
  PlaneTransform t;
  t.functions = {2, 0};
  t.rank = 1;
  t.colour = {{{512, 0, 0}, {0, 0, 512}, {0, -256, 0}}};
  t.matrix = {1 << 14, -(1 << 13)};
  t.components = {1};
  // Channels 3, -4, -3.5 to -3; halves up.
  EXPECT_EQ(given_planes(point_of(3, {1, 2}, t, {5, 5, 5, 3, 7, -4})),
            (std::vector<std::int32_t>{-1, 2, 2, 5, 5, 5, 3, -4, -3}));
}

TEST(Spec_8_7_5_Expansion, MixesChannelsWithFunctionsWhereJoint) {
  PlaneTransform t;
  t.functions = {0, 1};
  t.rank = 1;
  t.lanes = 1;
  t.matrix.assign(18, 0);
  t.matrix[0] = t.matrix[6 + 4] = t.matrix[12 + 5] = 1 << 14;
  t.matrix[6 + 5] = 3 << 13;
  t.components = {0};
  EXPECT_EQ(given_planes(point_of(2, {0}, t, {7, 3, -2})),
            (std::vector<std::int32_t>{7, 0, 0, 0, 3, 3}));
}

TEST(Spec_8_7_5_Expansion, ClampsWhat32BitsDoNotHold) {
  constexpr std::int32_t kMost = 0x7FFFFFFF;
  PlaneTransform t;
  t.functions = {0, 1};
  t.rank = 1;
  t.matrix = {PlaneTransform::kEntryLimit, -PlaneTransform::kEntryLimit};
  t.components = {0};
  EXPECT_EQ(given_planes(point_of(2, {0}, t, {kMost, -(1 << 25), (1 << 25) - 1})),
            (std::vector<std::int32_t>{kMost, -kMost, kMost - 63, -kMost, kMost, -kMost + 63}));
}

TEST(Spec_8_7_5_Expansion, WithoutATransformPlanesAreComponents) {
  LightField field = point_of(3, {1}, {}, {1, 2, 3});
  field.header.transforms.clear();
  EXPECT_EQ(given_planes(field), (std::vector<std::int32_t>{0, 0, 0, 1, 2, 3, 0, 0, 0}));
}

/// Planes that are mixtures of a few, and noise.
LightField mixed_field(int functions, const std::vector<Voxel>& voxels, int bits) {
  LightField field = test::make_field(voxels, bits, functions, 4000);
  std::mt19937 random(3);
  std::vector<std::int32_t> mixture;
  for (int k = 0; k < functions; ++k)
    mixture.push_back(static_cast<std::int32_t>(random() % 9) - 4);
  for (std::size_t p = 0; p < field.num_points(); ++p)
    for (std::size_t k = 1; k < mixture.size(); ++k)
      for (std::size_t c = 0; c < 3; ++c)
        field.components[(p * mixture.size() + k) * 3 + c] =
            mixture[k] * field.components[p * mixture.size() * 3] / 8 +
            static_cast<std::int32_t>(random() % 7);
  return field;
}

CodingParameters with_transform(TransformMode mode, int functions, std::uint32_t step) {
  CodingParameters parameters;
  parameters.transform = mode;
  parameters.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  return parameters;
}

double mean_square(const LightField& decoded, const LightField& given) {
  const std::vector<std::int32_t> planes = given_planes(decoded);
  double sum = 0;
  for (std::size_t i = 0; i < given.components.size(); ++i)
    sum += std::pow(planes.at(i) - given.components[i], 2.0);
  return sum / static_cast<double>(given.components.size());
}

class TransformModes : public testing::TestWithParam<TransformMode> {};

TEST_P(TransformModes, CostFewerBytesAtNoLargerErrorWherePlanesAreAlike) {
  const LightField field = mixed_field(16, test::sphere_cloud(7), 7);
  CodingParameters parameters = with_transform(TransformMode::kNone, 16, 32);
  const auto plain = pack(field, parameters);
  parameters.transform = GetParam();
  const auto transformed = pack(field, parameters);
  ASSERT_TRUE(plain && transformed);
  EXPECT_LT(transformed->size(), plain->size() * 8 / 10);
  const auto a = decode(*plain), b = decode(*transformed);
  ASSERT_TRUE(a && b) << to_string(b.error());  // the digest holds: the encoder knows what we get
  EXPECT_LT(mean_square(*b, field), 2 * mean_square(*a, field));
  EXPECT_LT(b->num_planes(), a->num_planes() / 2);  // components of what is coded, no more
  EXPECT_EQ(b->components.size(), b->num_points() * std::size_t(b->num_planes()));
  const auto info = read_info(*transformed);
  ASSERT_TRUE(info);
  ASSERT_FALSE(info->transforms.empty());
  EXPECT_EQ(info->transforms[0].joint, GetParam() == TransformMode::kJoint);
}

TEST_P(TransformModes, GroupsAndLevelsCanBeLeftOutAndThreadsAndSlicesDoNotMatter) {
  const LightField field = mixed_field(12, test::sphere_cloud(6), 6);
  CodingParameters parameters = with_transform(GetParam(), 12, 16);
  parameters.group = {0, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3};
  parameters.coefficient_level_ends = {4, 5, 6};
  parameters.max_slice_points = 1000;
  parameters.threads = 1;
  const auto stream = pack(field, parameters);
  ASSERT_TRUE(stream);
  parameters.threads = 3;
  EXPECT_EQ(*pack(field, parameters), *stream);
  double before = 1e30;
  for (int groups = 1; groups <= 4; ++groups) {
    DecodeOptions options;
    options.groups = groups;
    const auto decoded = decode(*stream, options);
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    const double error = mean_square(*decoded, field);
    EXPECT_LE(error, before * 1.01) << groups;
    before = error;
    options.levels = 3;
    EXPECT_TRUE(decode(*stream, options));
  }
}

TEST_P(TransformModes, EveryShapeOfCloudGoesThrough) {
  for (const auto& cloud : test::clouds_of_every_shape()) {
    const LightField field = mixed_field(5, cloud.voxels, cloud.bits);
    const auto stream = pack(field, with_transform(GetParam(), 5, 4));
    ASSERT_TRUE(stream) << cloud.name;
    const auto decoded = decode(*stream);
    ASSERT_TRUE(decoded) << cloud.name << to_string(decoded.error());
    // What is dropped costs no more than its column would: a few squared steps a point.
    EXPECT_LT(mean_square(*decoded, field), 4 * 4 * 4) << cloud.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_5, TransformModes,
                         testing::Values(TransformMode::kFunctions, TransformMode::kJoint),
                         testing::PrintToStringParamName());

/// A stream with one transform, without its end unit and the index.
std::vector<Unit> units_with_transform(std::vector<std::uint8_t>& stream) {
  const LightField field = mixed_field(8, test::sphere_cloud(4), 4);
  CodingParameters parameters = with_transform(TransformMode::kFunctions, 8, 8);
  parameters.index = false;
  stream = *pack(field, parameters);
  std::vector<Unit> units = split_units(stream)->units;
  units.pop_back();
  return units;
}

std::vector<std::uint8_t> stream_of(const std::vector<Unit>& units) {
  std::vector<std::uint8_t> stream(kSignature.begin(), kSignature.end());
  for (const Unit& unit : units) append_unit(stream, unit.type, unit.payload);
  return stream;
}

TEST(Spec_7_11_Hazards, MissingRepeatedAndLateUnitsAreRefused) {
  std::vector<std::uint8_t> stream;
  const auto units = units_with_transform(stream);
  ASSERT_EQ(units[1].type, UnitType::kTransform);
  EXPECT_TRUE(decode(stream_of(units)));
  auto missing = units, repeated = units, late = units;
  missing.erase(missing.begin() + 1);
  repeated.insert(repeated.begin() + 1, units[1]);
  late.push_back(units[1]);
  for (const auto& changed : {missing, repeated, late}) EXPECT_FALSE(decode(stream_of(changed)));
}

TEST(Spec_7_11_Hazards, NoDamagedByteGivesAnotherLightField) {
  std::vector<std::uint8_t> stream;
  auto units = units_with_transform(stream);
  const auto sound = decode(stream);
  ASSERT_TRUE(sound);
  const auto set = *parse_sequence_parameter_set(units[0].payload);
  const auto first = std::find_if(units.begin(), units.end(), [](const Unit& unit) {
    return unit.type == UnitType::kCoefficients;
  });
  const std::vector<std::uint8_t> whole(first->payload.begin(), first->payload.end());
  const PartUnit part = *read_part_unit(*first, set);
  ASSERT_GT(part.matrix.size(), 4u);
  for (std::size_t at = 0; at < whole.size() - part.payload.size(); ++at)
    for (const unsigned flip : {0x01u, 0x80u, 0xFFu}) {
      auto damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
      first->payload = damaged;
      // Refused, at the latest by the digest; or what changed was a factor of zeros.
      const auto field = decode(stream_of(units));
      EXPECT_TRUE(!field || field->components == sound->components) << at;
    }
}

TEST(Spec_7_2_Hazards, ATextureHasNoTransform) {
  CodingParameters parameters = with_transform(TransformMode::kFunctions, 4, 8);
  parameters.coefficients = CoefficientCoder::kTexture;
  EXPECT_FALSE(pack(test::make_field(test::sphere_cloud(4), 4, 4), parameters));
}

}  // namespace
}  // namespace slf::plane_transform_test
