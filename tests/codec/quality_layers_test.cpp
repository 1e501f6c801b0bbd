// SPDX-License-Identifier: Apache-2.0
// Coefficients in layers: each halves the step of those before. Spec 8.7.4, 8.7.7, 8.9.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "attributes/coefficient_decoder.h"
#include "attributes/quantiser.h"
#include "bitstream/units.h"
#include "conformance/fields.h"
#include "entropy/range_decoder.h"
#include "entropy/range_encoder.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/truncate.h"

namespace slf::quality_layers_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

LightField scene() { return conformance::field(conformance::sphere(5), 5, 9); }

CodingParameters with_layers(int layers, int base_levels, std::uint32_t slice_points) {
  CodingParameters parameters = conformance::with_steps(9, 30);
  parameters.group = {0, 1, 1, 2, 2, 2, 2, 2, 2};
  parameters.coefficient_level_ends = {3, 4, 5};
  parameters.geometry_level_ends = {2, 5};
  parameters.quality_layers = layers;
  parameters.base_levels = base_levels;
  parameters.max_slice_points = slice_points;
  return parameters;
}

LightField decoded(const Bytes& stream, int layers = 0, int threads = 1) {
  DecodeOptions options;
  options.layers = layers;
  options.threads = threads;
  auto field = decode(stream, options);
  EXPECT_TRUE(field) << to_string(field.error());
  return field ? *field : LightField{};
}

double error(const LightField& a, const LightField& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.components.size(); ++i)
    sum += std::pow(double{1} * a.components[i] - b.components[i], 2);
  return sum;
}

struct Shape {
  int base_levels;
  std::uint32_t slice_points;
};
void PrintTo(const Shape& shape, std::ostream* out) {
  *out << (shape.base_levels == 0 ? "no_base" : shape.slice_points > (1 << 16) ? "base" : "slices");
}

class QualityLayersTest : public testing::TestWithParam<Shape> {
 protected:
  Bytes packed(int layers) const {
    return *pack(scene(), with_layers(layers, GetParam().base_levels, GetParam().slice_points));
  }
};

TEST_P(QualityLayersTest, AllLayersGiveWhatASingleOneGives) {
  const LightField single = decoded(packed(1));
  for (int layers = 2; layers <= 4; ++layers)
    EXPECT_EQ(decoded(packed(layers)).components, single.components) << layers;
}

TEST_P(QualityLayersTest, EveryLayerIsNearer) {
  const Bytes stream = packed(4);
  const LightField field = scene();
  double before = INFINITY;
  for (int layers = 1; layers <= 4; ++layers) {
    const LightField some = decoded(stream, layers);
    EXPECT_EQ(some.partial, layers < 4);
    EXPECT_EQ(some.positions.size(), field.num_points());
    const double now = error(some, field);
    EXPECT_LT(now, 0.6 * before) << layers;  // half of the step is a quarter of the error at best
    before = now;
  }
}

TEST_P(QualityLayersTest, ACutToLayersDecodesAsThatManyAskedFor) {
  const Bytes stream = packed(3);
  for (int layers = 1; layers <= 3; ++layers) {
    DecodeOptions options;
    options.layers = layers;
    const auto cut = truncate(stream, options);
    ASSERT_TRUE(cut) << to_string(cut.error());
    EXPECT_EQ(decoded(*cut).components, decoded(stream, layers).components) << layers;
    if (layers < 3) {
      EXPECT_LT(cut->size(), stream.size());
    }
    const auto left = read_info(*cut)->cut;
    EXPECT_EQ(left.has_value(), layers < 3);  // of all layers nothing is cut off
    EXPECT_EQ(left ? left->layers : 0, layers < 3 ? layers : 0);
  }
}

TEST_P(QualityLayersTest, EveryPrefixDecodesAndThreadsDoNotMatter) {
  const Bytes stream = packed(3);
  const Units units = *split_units(stream);
  const LightField field = scene();
  double first = 0;  // error of the first layer alone
  for (const Unit& unit : units.units) {
    if (unit.type != UnitType::kRefinement) continue;
    const Bytes prefix(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(unit.offset));
    const LightField some = decoded(prefix);
    EXPECT_TRUE(some.partial);
    EXPECT_EQ(some.components, decoded(prefix, 0, 3).components);
    if (some.components.size() == field.components.size() && first == 0) first = error(some, field);
  }
  EXPECT_LT(error(decoded(stream), field), first / 4);
}

TEST_P(QualityLayersTest, LayersCostLittle) {
  // Two layers of the captures of docs/decisions/006 cost 0.4 to 1.0 %.
  EXPECT_LT(static_cast<double>(packed(2).size()), 1.06 * static_cast<double>(packed(1).size()));
}

INSTANTIATE_TEST_SUITE_P(Spec_8_7_7, QualityLayersTest,
                         testing::Values(Shape{0, 1u << 20}, Shape{2, 1u << 20}, Shape{2, 700}),
                         testing::PrintToStringParamName());

TEST(Spec_8_9_QualityLayers, MoreThanThereAreAreRefused) {
  const Bytes stream = *pack(scene(), with_layers(2, 0, 1u << 20));
  DecodeOptions options;
  options.layers = 3;
  const auto field = decode(stream, options);
  ASSERT_FALSE(field);
  EXPECT_EQ(field.error().code, Errc::kInvalidArgument);
  EXPECT_STREQ(field.error().element, "layers");
}

TEST(Spec_7_2_QualityLayers, TheEncoderRefusesWhatTheFormatHasNot) {
  for (const int layers : {0, 5}) EXPECT_FALSE(pack(scene(), with_layers(layers, 0, 1u << 20)));
  CodingParameters parameters = with_layers(2, 0, 1u << 20);
  parameters.coefficients = CoefficientCoder::kIndependent;
  EXPECT_FALSE(pack(scene(), parameters));
  parameters = with_layers(2, 0, 1u << 20);
  parameters.group_layers = {2, 2};
  EXPECT_FALSE(pack(scene(), parameters));
}

TEST(Spec_8_7_4_Dequantise, MissingLayersLeaveAValueNearTheLowerEndOfWhatItMayBe) {
  for (const std::int32_t value : {0, 1, -1, 5, -1000})
    for (const std::uint32_t step : {1u, 8u, 333u})
      for (int missing = 0; missing <= 3; ++missing) {
        std::int32_t got = value;
        ASSERT_TRUE(dequantise(got, step, missing));
        const std::int64_t least = (std::abs(std::int64_t{value}) << missing) * step;
        const std::int64_t most = least + ((std::int64_t{1} << missing) - 1) * step;
        EXPECT_GE(std::abs(std::int64_t{got}), least);
        EXPECT_LE(std::abs(std::int64_t{got}), value == 0 ? 0 : (least + most) / 2);
        EXPECT_EQ(got < 0, value < 0);
      }
  std::int32_t large = 1 << 26;
  EXPECT_FALSE(dequantise(large, 1, 1));
  large = (1 << 24) - 1;
  EXPECT_TRUE(dequantise(large, 1, 3));
  EXPECT_EQ(large, (1 << 27) - 6);  // 2^27 - 8, and 21 / 8
}

/// Values of every size through a layer and its refinement.
TEST(Spec_8_7_7_Refinement, GivesBackValuesOfEverySize) {
  const auto voxels = conformance::sphere(5);
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : voxels) codes.push_back(morton(v));
  const RahtTree tree = build_raht_tree(codes);
  std::vector<std::uint32_t> first(codes.size() + 1);
  std::iota(first.begin(), first.end(), 0u);
  const PlaneGroups groups = {{0}, {1, 2, 3, 4, 5, 6}};
  constexpr std::size_t kPlanes = 21;
  conformance::Random random(3);
  std::vector<std::int32_t> fine(codes.size() * kPlanes);
  for (std::int32_t& value : fine)
    if (random.below(3) == 0)
      value = static_cast<std::int32_t>(random.below(1u << random.below(27))) *
              (random.below(2) == 0 ? 1 : -1);
  std::vector<std::int32_t> coarse = fine;
  for (std::int32_t& value : coarse) value /= 2;
  std::vector<std::int32_t> got(fine.size());
  CoefficientModels writer(groups, tree, codes, first, true, {}, 2),
      reader(groups, tree, codes, first, true, {}, 2);
  for (std::size_t layer = 0; layer < 2; ++layer)
    for (std::size_t g = 0; g < groups.size(); ++g) {
      RangeEncoder encoder;
      writer.code(encoder, {tree, layer == 0 ? coarse : fine, kPlanes}, g, 0, codes.size(), layer);
      const Bytes unit = encoder.finish();
      const auto done =
          decode_coefficients(unit, reader, {tree, got, kPlanes}, g, 0, codes.size(), false, layer);
      ASSERT_TRUE(done) << to_string(done.error());
    }
  EXPECT_EQ(got, fine);
}

}  // namespace
}  // namespace slf::quality_layers_test
