// SPDX-License-Identifier: Apache-2.0
// Colours by the C interface: weights, functions, tables, means.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "c_api_objects.h"
#include "lightfield/function_weights.h"
#include "slf/decoder.h"
#include "slf/slf.h"
#include "slf/view_map.h"

namespace slf::c_api_radiance_test {
namespace {

using test::Bytes;
using test::Field;
using test::name_of;
using test::Stream;
using test::stream_of;

/// Directions all around.
std::vector<float> directions(std::size_t count) {
  std::vector<float> out;
  for (std::size_t i = 0; i < count; ++i) {
    const float t = static_cast<float>(i);
    for (const float x : {std::cos(t), std::sin(1.7f * t), std::cos(2.3f * t + 1)})
      out.push_back(x);
  }
  return out;
}

class CApiRadiance : public testing::TestWithParam<const char*> {};

TEST_P(CApiRadiance, WeightsTimesFunctionsAreTheViewMaps) {
  const Bytes bytes = stream_of(GetParam());
  const Stream stream(bytes);
  const Field field(stream.handle, nullptr);
  const auto light_field = decode(bytes);
  ASSERT_TRUE(light_field);
  const ViewMaps maps(*light_field);
  const std::size_t count = 60, functions = field.shape.weights;
  const auto along = directions(count);
  std::vector<float> weights(field.shape.points * functions * 3), colours(3 * count);
  std::vector<std::uint32_t> points;
  for (std::size_t i = 0; i < count; ++i)
    points.push_back(static_cast<std::uint32_t>(i * 7 % field.shape.points));
  ASSERT_EQ(slf_read_weights(field.handle, 0, field.shape.points, weights.data(), 0, nullptr),
            SLF_OK);
  ASSERT_EQ(
      slf_read_radiance(field.handle, count, points.data(), along.data(), colours.data(), nullptr),
      SLF_OK);
  for (std::size_t i = 0; i < count; ++i) {
    const auto [theta, gamma] = direction_of({along[3 * i], along[3 * i + 1], along[3 * i + 2]});
    const auto expected = maps.radiance(points[i], theta, gamma);
    std::vector<float> framed(3), row(functions);
    ASSERT_EQ(slf_local_direction(field.handle, points[i], &along[3 * i], framed.data(), nullptr),
              SLF_OK);
    ASSERT_EQ(slf_read_functions(field.handle, 1, framed.data(), row.data(), 0, nullptr), SLF_OK);
    for (std::size_t c = 0; c < 3; ++c) {
      float sum = 0;
      for (std::size_t r = 0; r < functions; ++r)
        sum += row[r] * weights[(points[i] * functions + r) * 3 + c];
      // Both are documented within 1/50 of a grey level of the definition.
      EXPECT_NEAR(colours[3 * i + c], expected[c], 0.04) << "point " << points[i];
      EXPECT_NEAR(std::clamp(sum, 0.0f, 255.0f), expected[c], 0.04) << "point " << points[i];
    }
  }
}

TEST_P(CApiRadiance, DirectionsWithoutALengthAreRefused) {
  const Stream stream(stream_of(GetParam()));
  const Field field(stream.handle, nullptr);
  const std::uint32_t points[] = {0, 0};
  std::vector<float> row(field.shape.weights), colours(6);
  for (const float wrong : {0.0f, std::nanf(""), INFINITY}) {
    const float along[] = {0, 0, 1, 0, wrong, 0};
    EXPECT_EQ(slf_read_radiance(field.handle, 2, points, along, colours.data(), nullptr),
              SLF_INVALID_ARGUMENT);
    EXPECT_EQ(slf_local_direction(field.handle, 0, along + 3, colours.data(), nullptr),
              SLF_INVALID_ARGUMENT);
    EXPECT_EQ(slf_read_functions(field.handle, 1, along + 3, row.data(), 0, nullptr),
              SLF_INVALID_ARGUMENT);
  }
}

TEST_P(CApiRadiance, TheCubeHoldsTheFunctionsAtItsTexels) {
  const Stream stream(stream_of(GetParam()));
  const Field field(stream.handle, nullptr);
  constexpr std::uint32_t kSide = 5;
  const std::size_t functions = field.shape.weights, layers = (functions + 3) / 4;
  std::vector<float> cube(layers * 24 * kSide * kSide), row(functions);
  ASSERT_EQ(slf_read_function_cube(field.handle, kSide, cube.data(), cube.size(), nullptr), SLF_OK);
  // The middle of a face looks along its axis, its corners along diagonals: GL's order and signs.
  const float middle[6][3] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  const float corner[6][3] = {{1, 1, 1},   {-1, 1, -1}, {-1, 1, -1},
                              {-1, -1, 1}, {-1, 1, 1},  {1, 1, -1}};
  for (std::size_t face = 0; face < 6; ++face)
    for (const auto& [direction, texel] :
         {std::pair{middle[face], 2 * kSide + 2}, std::pair{corner[face], 0u}}) {
      ASSERT_EQ(slf_read_functions(field.handle, 1, direction, row.data(), 0, nullptr), SLF_OK);
      for (std::size_t r = 0; r < functions; ++r)
        EXPECT_NEAR(cube[((r / 4 * 6 + face) * kSide * kSide + texel) * 4 + r % 4], row[r], 1e-4)
            << face;
    }
  EXPECT_EQ(slf_read_function_cube(field.handle, kSide, cube.data(), cube.size() - 1, nullptr),
            SLF_INVALID_ARGUMENT);
}

INSTANTIATE_TEST_SUITE_P(Spec_6_7, CApiRadiance, testing::Values("harmonics", "basis"), name_of);

/// Six points, four functions of which two are coded, with a transform that no rounding hides.
LightField field_with_transform(std::size_t lanes) {
  LightField field;
  LightFieldHeader& header = field.header;
  header.grid.bits = 3;
  header.basis = {BasisId::kHarmonics, 2, 4, 3, 1};
  header.num_functions = 4;
  header.colour = ColourTransform::kOpponent;
  header.shift = {4, 4, 5, 3};
  header.coded = {0, 1};
  PlaneTransform t;
  t.functions = {0, 1, 2, 3};
  t.rank = 2;
  t.lanes = lanes;
  t.components = {0, 1};
  for (std::size_t i = 0; i < t.rows() * t.columns(); ++i)
    t.matrix.push_back(static_cast<std::int32_t>((i * 7919 + 3) % 21) * 1024 - 9216);
  header.transforms = {t};
  for (int p = 0; p < 6; ++p) {
    field.positions.push_back({p, 0, 0});
    for (int j = 0; j < 6; ++j) field.components.push_back((p * 37 + j * 101) % 4000 - 900);
  }
  return field;
}

TEST(Spec_6_7_FunctionWeights, TransformsAreOfTheFunctionsJointOnesOfTheWeights) {
  for (const std::size_t lanes : {3u, 1u}) {
    const LightField field = field_with_transform(lanes);
    const ViewMaps maps(field);
    const FunctionWeights source(field, 1);
    ASSERT_EQ(source.size(), lanes == 3 ? 2u : 4u);
    std::vector<float> row(source.stride()), weights(3 * source.size());
    const auto along = directions(30);
    double spread = 0;
    for (std::size_t i = 0; i < 30; ++i) {
      const Vec3 v{along[3 * i], along[3 * i + 1], along[3 * i + 2]};
      const auto [theta, gamma] = direction_of(v);
      const auto expected = maps.radiance_unclamped(i % 6, theta, gamma);
      source.functions(v, row.data());
      source.weights(i % 6, weights.data());
      for (std::size_t c = 0; c < 3; ++c) {
        float sum = 0;
        for (std::size_t r = 0; r < source.size(); ++r) sum += row[r] * weights[3 * r + c];
        EXPECT_NEAR(sum, expected[c], 0.05);
        spread = std::max(spread, std::abs(double(sum)));
      }
    }
    EXPECT_GT(spread, 10) << "no colours to compare";
  }
}

TEST(CApi, MeanColoursAreTheLibrarysRounded) {
  const Bytes bytes = stream_of("harmonics");
  const Stream stream(bytes);
  const Field field(stream.handle, nullptr);
  const auto means = mean_colours(*decode(bytes));
  std::vector<std::uint8_t> out(3 * means.size());
  ASSERT_EQ(slf_read_mean_colours(field.handle, 0, means.size(), out.data(), 0, nullptr), SLF_OK);
  for (std::size_t p = 0; p < means.size(); ++p)
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(out[3 * p + c], means[p][c], 0.5001);
}

}  // namespace
}  // namespace slf::c_api_radiance_test
