// Planes as pictures: the atlas, and the way through pack and decode. Spec 8.11.
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "bitstream/bit_writer.h"
#include "bitstream/units.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/field_support.h"
#include "texture/atlas.h"
#include "texture/box_packing.h"
#include "texture/charts.h"
#include "texture/padding.h"
#include "video/hevc_decoder.h"
#include "video/hevc_encoder.h"

namespace slf {
namespace {

using test::NamedCloud;

#define SKIP_WITHOUT_HEVC() \
  if (const char* lacking = lacks()) GTEST_SKIP() << lacking

/// What this build needs for pictures and does not have, or null.
const char* lacks() {
  const auto blank = [](std::size_t) { return blank_picture(64, 64, 8, ChromaFormat::k400); };
  if (!encode_hevc(1, blank, {})) return "built without x265 (SLF_X265)";
  const auto none = decode_hevc({}, {64, 64, 8, ChromaFormat::k400, 1}, [](auto, const auto&) {});
  if (!none && none.error().code == Errc::kUnsupported) return "built without libde265 (SLF_HEVC)";
  return nullptr;
}

void expect_a_pixel_for_every_point(const Atlas& atlas, std::size_t points) {
  EXPECT_EQ(atlas.width % 8, 0);
  EXPECT_EQ(atlas.height % 8, 0);
  EXPECT_GE(std::min(atlas.width, atlas.height), 64);
  EXPECT_LE(std::max(atlas.width, atlas.height), 8192);
  ASSERT_EQ(atlas.pixel.size(), points);
  std::vector<bool> used(static_cast<std::size_t>(atlas.width * atlas.height));
  for (const std::uint32_t pixel : atlas.pixel) {
    ASSERT_LT(pixel, used.size());
    ASSERT_FALSE(used[pixel]) << "two points at " << pixel;
    used[pixel] = true;
  }
}

class TextureAtlas : public testing::TestWithParam<NamedCloud> {};

TEST_P(TextureAtlas, EveryPointHasAPixelOfItsOwn) {
  for (int cell_log2 = 0; cell_log2 <= kMostCellLog2; ++cell_log2) {
    const auto atlas = derive_atlas(test::codes(GetParam().voxels), GetParam().bits, cell_log2);
    ASSERT_TRUE(atlas);
    expect_a_pixel_for_every_point(*atlas, GetParam().voxels.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_11, TextureAtlas, testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_11_3_Charts, APlaneIsOneChartAndKeepsItsShape) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Voxel> voxels;
    for (std::int32_t a = 0; a < 40; ++a)
      for (std::int32_t b = 0; b < 24; ++b) {
        Voxel v{};
        v[axis] = 11;
        v[(axis + 1) % 3] = 5 + a;
        v[(axis + 2) % 3] = 9 + b;
        voxels.push_back(v);
      }
    voxels = test::sorted_distinct(voxels);
    const auto atlas = derive_atlas(test::codes(voxels), 6, 0);
    ASSERT_TRUE(atlas);
    EXPECT_EQ(atlas->num_charts, 1u);
    EXPECT_EQ(atlas->num_loose, 0u);
    for (std::size_t p = 0; p < voxels.size(); ++p) {  // lying: the longer side is x
      EXPECT_EQ(atlas->pixel[p] % 64, static_cast<std::uint32_t>(voxels[p][(axis + 1) % 3] - 5));
      EXPECT_EQ(atlas->pixel[p] / 64, static_cast<std::uint32_t>(voxels[p][(axis + 2) % 3] - 9));
    }
  }
}

TEST(Spec_8_11_3_Charts, ABoxStaysWithin512Pixels) {
  std::vector<Voxel> voxels;
  for (std::int32_t x = 0; x < 1500; ++x)
    for (std::int32_t y = 0; y < 8; ++y) voxels.push_back({x, y, 3});
  const auto atlas = derive_atlas(test::codes(test::sorted_distinct(voxels)), 11, 0);
  ASSERT_TRUE(atlas);
  EXPECT_EQ(atlas->num_charts, 3u);
  expect_a_pixel_for_every_point(*atlas, voxels.size());
}

TEST(Spec_8_11_1_Cells, PointsTwoApartHoldTogetherInCellsOfTwo) {
  std::vector<Voxel> voxels;
  for (std::int32_t x = 0; x < 64; x += 2)
    for (std::int32_t y = 0; y < 64; y += 2) voxels.push_back({x, y, 31});
  const auto codes = test::codes(test::sorted_distinct(voxels));
  EXPECT_EQ(derive_atlas(codes, 6, 0)->num_loose, voxels.size());
  EXPECT_EQ(derive_atlas(codes, 6, 1)->num_loose, 0u);
  EXPECT_EQ(derive_atlas(codes, 6, 2)->num_loose, voxels.size() * 3 / 4);
}

/// Geometry made to hurt: the atlas stays within 8 pixels a point and a row of tiles.
TEST(Spec_8_11_Hazards, HostileCloudsGiveBoundedAtlases) {
  std::vector<NamedCloud> clouds = {{"random", 21, test::random_cloud(1 << 20, 21, 3)},
                                    {"dense noise", 7, test::random_cloud(1 << 20, 7, 4)},
                                    {"cube", 7, {}},
                                    {"diagonal", 16, {}},
                                    {"patches", 12, {}},
                                    {"sticks", 12, {}}};
  for (std::int32_t z = 0; z < 100; ++z)
    for (std::int32_t y = 0; y < 100; ++y)
      for (std::int32_t x = 0; x < 100; ++x) clouds[2].voxels.push_back({x, y, z});
  for (std::int32_t i = 0; i < 1 << 16; ++i) clouds[3].voxels.push_back({i, i, i});
  for (std::int32_t i = 0; i < 1 << 16; ++i)  // charts of the least size
    for (std::int32_t j = 0; j < 16; ++j)
      clouds[4].voxels.push_back({i % 256 * 16 + j % 4, i / 256 * 16 + j / 4, 8});
  for (std::int32_t i = 0; i < 1 << 14; ++i)  // thin boxes, hard to pack
    for (std::int32_t j = 0; j < 20 + i % 23; ++j)
      clouds[5].voxels.push_back({i % 64 * 64 + j, i / 64 * 16, 8});
  for (const NamedCloud& cloud : clouds) {
    SCOPED_TRACE(cloud.name);
    const auto codes = test::codes(test::sorted_distinct(cloud.voxels));
    const auto atlas = derive_atlas(codes, cloud.bits, 0);
    ASSERT_TRUE(atlas);
    expect_a_pixel_for_every_point(*atlas, codes.size());
    EXPECT_LE(static_cast<std::size_t>(atlas->width) * static_cast<std::size_t>(atlas->height),
              16 * codes.size() + 64 * 8192);
  }
}

TEST(Spec_8_11_4_Boxes, EachGoesToTheLowestPlaceThenTheLeftmost) {
  std::vector<Box> boxes = {{3, 4}, {2, 3}, {2, 2}, {2, 1}, {7, 1}};
  EXPECT_EQ(pack_boxes(boxes, 7), 5);
  const std::vector<std::array<std::int32_t, 2>> places = {{0, 0}, {3, 0}, {5, 0}, {5, 2}, {0, 4}};
  for (std::size_t i = 0; i < boxes.size(); ++i)
    EXPECT_EQ((std::array{boxes[i].x, boxes[i].y}), places[i]) << i;
}

TEST(TexturePadding, KeepsWhatIsOccupiedAndStaysBetweenItsExtremes) {
  std::vector<std::uint16_t> samples(72 * 40, 4095);
  std::vector<std::uint8_t> occupied(samples.size(), 0);
  for (std::size_t i = 0; i < samples.size(); i += 37) {
    samples[i] = static_cast<std::uint16_t>(100 + i % 700);
    occupied[i] = 1;
  }
  auto padded = samples;
  pad_picture(padded, occupied, 72, 40);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (occupied[i]) {
      EXPECT_EQ(padded[i], samples[i]);
    }
    EXPECT_GE(padded[i], 100);
    EXPECT_LT(padded[i], 800);
  }
}

CodingParameters texture_coding(int functions, std::uint32_t step, int bits, bool lossless) {
  CodingParameters parameters;
  parameters.coefficients = CoefficientCoder::kTexture;
  parameters.step.assign(static_cast<std::size_t>(functions), {step, step, step});
  parameters.texture.bits = bits;
  parameters.texture.lossless = lossless;
  parameters.texture.preset = "superfast";
  return parameters;
}

std::vector<std::uint8_t> packed(const LightField& field, const CodingParameters& parameters) {
  auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return stream ? *stream : std::vector<std::uint8_t>{};
}

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

/// The first coefficient unit's payload behind level_range, slice_id and plane_group replaced.
std::vector<std::uint8_t> with_texture_unit(
    const std::vector<std::uint8_t>& stream,
    const std::function<std::vector<std::uint8_t>(std::vector<std::uint8_t>)>& edit) {
  std::vector<std::uint8_t> out(kSignature.begin(), kSignature.end());
  bool done = false;
  const Units units = *split_units(stream);
  for (const Unit& unit : units.units) {
    std::vector<std::uint8_t> payload(unit.payload.begin(), unit.payload.end());
    if (unit.type == UnitType::kCoefficients && !std::exchange(done, true)) payload = edit(payload);
    append_unit(out, unit.type, payload);
  }
  return out;
}

void expect_refused(const std::vector<std::uint8_t>& stream, const char* element) {
  const auto decoded = decode(stream);
  ASSERT_FALSE(decoded) << element;
  EXPECT_STREQ(decoded.error().element, element);
}

/// A unit of one group of three planes: their flags and offsets, then `pictures`.
std::vector<std::uint8_t> texture_unit(std::uint64_t level_range,
                                       const std::vector<std::pair<int, std::int64_t>>& planes,
                                       std::span<const std::uint8_t> pictures = {}) {
  BitWriter out;
  out.ue(level_range);
  out.ue(0);
  out.ue(0);
  out.align();
  for (const auto& [flag, offset] : planes) {
    out.u(1, static_cast<std::uint64_t>(flag));
    out.se(offset);
  }
  out.append(pictures);
  return out.take();
}

TEST(Spec_7_6_Hazards, UnitsOutOfRangeAreRefusedByName) {
  LightField field = test::make_field(test::sphere_cloud(4), 4, 1);
  std::fill(field.components.begin(), field.components.end(), 5);
  CodingParameters parameters = texture_coding(1, 1 << 20, 12, false);
  parameters.index = parameters.digest = false;
  const auto stream = packed(field, parameters);
  const auto edited = [&](const std::vector<std::uint8_t>& unit) {
    return with_texture_unit(stream, [&](const auto&) { return unit; });
  };
  const std::vector<std::uint8_t> byte = {0};
  ASSERT_TRUE(decode(edited(texture_unit(0, {{0, 1}, {0, -2}, {0, (1 << 30) - 1}}))));
  expect_refused(edited(texture_unit(1, {{0, 1}, {0, 1}, {0, 1}})), "level_range");
  expect_refused(edited(texture_unit(0, {{0, 1}, {0, 1}, {0, 1 << 30}})), "tx_offset");
  expect_refused(edited(texture_unit(0, {{0, 1}, {1, -(1 << 20)}, {0, 1}})), "tx_offset");
  expect_refused(edited(texture_unit(0, {{0, 1}, {0, 1}, {0, 1}}, byte)), "tx_pictures");
  expect_refused(edited(texture_unit(0, {{0, 1}})), "tx_offset");
}

TEST(Spec_7_6_Hazards, EveryTruncationAndFlippedByteGivesAValueOrAnError) {
  SKIP_WITHOUT_HEVC();
  CodingParameters parameters = texture_coding(1, 16, 8, false);
  parameters.index = parameters.digest = false;
  const auto stream = packed(test::make_field(test::sphere_cloud(4), 4, 1), parameters);
  std::size_t size = 0;
  with_texture_unit(stream, [&](auto payload) { return size = payload.size(), payload; });
  for (std::size_t at = 0; at < size; ++at) {
    (void)decode(
        with_texture_unit(stream, [&](auto payload) { return payload.resize(at), payload; }));
    const auto damaged = with_texture_unit(stream, [&](auto payload) {
      payload[at] = static_cast<std::uint8_t>(payload[at] ^ 0x5A);
      return payload;
    });
    const auto decoded = decode(damaged);
    if (!decoded) {
      EXPECT_STRNE(decoded.error().element, "");
    }
  }
  const auto without_pictures =
      with_texture_unit(stream, [](auto payload) { return payload.resize(8), payload; });
  EXPECT_FALSE(decode(without_pictures));
}

}  // namespace
}  // namespace slf
