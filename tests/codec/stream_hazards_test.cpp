// SPDX-License-Identifier: Apache-2.0
// What a damaged, foreign or hostile stream may do: give an error that names its place. Nothing
// else.
#include <gtest/gtest.h>

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "field_support.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "tests/fuzz/fuzz.h"

namespace slf::stream_hazards_test {
namespace {

std::vector<std::uint8_t> small_stream(bool index = true) {
  LightField field = test::make_field(test::sphere_cloud(4), 4, 4, 300);
  field.header.has_basis = true;
  field.header.basis = {BasisId::kBspline, 2, 1, 1};
  field.header.grid = {{0.5, -2, 1e6}, 0.125, 4};
  field.normals.bits = 5;
  field.normals.octahedral.assign(field.num_points(), {3, 30});
  CodingParameters parameters;
  parameters.step.assign(4, {16, 20, 24});
  parameters.group = {0, 1, 1, 2};
  parameters.geometry_level_ends = {2, 4};
  parameters.coefficient_level_ends = {3, 4};
  parameters.base_levels = 2;
  parameters.max_slice_points = 150;
  parameters.index = index;
  parameters.metadata = {{"source", "test"}, {"empty", ""}};
  return *pack(field, parameters);
}

DecodeOptions small_limits() {
  DecodeOptions options;
  options.limits.max_points = 5000;
  options.limits.max_memory = 1 << 25;
  return options;
}

TEST(Spec_7_1_Hazards, EveryTruncationIsReportedOrIsAPartialLightField) {
  const auto whole = small_stream();
  ASSERT_TRUE(decode(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    // A fresh exact-size buffer, so AddressSanitizer sees a read one byte too far.
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(size));
    const auto decoded = decode(cut);
    if (decoded) {
      EXPECT_TRUE(decoded->partial) << size;
    } else {
      EXPECT_EQ(decoded.error().code, size == 0 ? Errc::kNotSlf : Errc::kTruncated) << size;
      EXPECT_LE(decoded.error().bit_offset, 8 * std::max<std::size_t>(size, 8));
    }
    (void)read_info(cut);
  }
}

TEST(Spec_7_1_Hazards, EveryFlippedByteIsNoticed) {
  const auto whole = small_stream();
  for (std::size_t at = 0; at < whole.size(); ++at)
    for (const unsigned mask : {0x01u, 0x80u, 0xFFu}) {
      auto damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ mask);
      EXPECT_FALSE(decode(damaged, small_limits())) << "byte " << at << " mask " << mask;
    }
}

TEST(Spec_7_1_Hazards, EveryFlippedByteBehindASoundCrcIsAnErrorOrALightField) {
  const auto whole = small_stream();
  for (std::size_t at = 8; at < whole.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      auto damaged = whole;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 1 << bit);
      damaged = fuzz::with_sound_crcs(damaged);
      const auto decoded = decode(damaged, small_limits());
      if (!decoded) {
        EXPECT_STRNE(decoded.error().element, "") << at;
      }
      (void)read_info(damaged);
    }
}

TEST(Spec_7_1_Hazards, ForeignFilesAreNotSlf) {
  for (const char* text : {"", "ply\nformat ascii 1.0\n", "\x89PNG\r\n\x1a\n....", "SLF"}) {
    const std::string s = text;
    const std::vector<std::uint8_t> bytes(s.begin(), s.end());
    const auto decoded = decode(bytes);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, Errc::kNotSlf);
  }
}

TEST(Spec_7_1_UnknownUnits, AreSkipped) {
  const auto whole = small_stream(false);
  const auto units = split_units(whole);
  ASSERT_TRUE(units);
  const Unit& sequence = units->units.front();
  const auto at = static_cast<std::ptrdiff_t>(sequence.offset + sequence.bytes);
  std::vector<std::uint8_t> extended(whole.begin(), whole.begin() + at);
  const std::vector<std::uint8_t> payload = {1, 2, 3};
  append_unit(extended, static_cast<UnitType>(99), payload);
  // Everything but the end unit, which must count one more.
  extended.insert(extended.end(), whole.begin() + at,
                  whole.begin() + static_cast<std::ptrdiff_t>(units->units.back().offset));
  BitWriter end;
  end.ue(units->units.size());
  append_unit(extended, UnitType::kEnd, end.take());
  const auto decoded = decode(extended), plain = decode(whole);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(decoded) << to_string(decoded.error());
  EXPECT_EQ(decoded->components, plain->components);
}

TEST(Spec_7_1_Hazards, BytesAfterTheEndAreRefused) {
  auto stream = small_stream();
  stream.push_back(0);
  EXPECT_FALSE(decode(stream));
}

TEST(Spec_7_1_Order, RepeatedUnitsOfASliceAreRefused) {
  const auto whole = small_stream(false);
  const auto units = split_units(whole);
  ASSERT_TRUE(units);
  for (const UnitType repeated : {UnitType::kSlices, UnitType::kGeometry, UnitType::kNormals,
                                  UnitType::kCoefficients, UnitType::kDigest}) {
    std::vector<std::uint8_t> stream(whole.begin(), whole.begin() + 8);
    std::uint64_t count = 0;
    for (const Unit& unit : units->units) {
      if (unit.type == UnitType::kEnd) {
        BitWriter end;
        end.ue(count);
        append_unit(stream, UnitType::kEnd, end.take());
        break;
      }
      for (int copies = unit.type == repeated ? 2 : 1; copies > 0; --copies, ++count)
        append_unit(stream, unit.type, unit.payload);
    }
    EXPECT_FALSE(decode(stream)) << unit_name(repeated);
  }
}

TEST(Spec_9_Limits, AreCheckedBeforeAnythingIsDecoded) {
  const auto stream = small_stream();
  const auto code_with = [&](auto change) {
    DecodeOptions options;
    change(options.limits);
    const auto decoded = decode(stream, options);
    return decoded ? Errc::kInvalidArgument : decoded.error().code;
  };
  EXPECT_EQ(code_with([](DecodeLimits& l) { l.max_points = 10; }), Errc::kLimitExceeded);
  EXPECT_EQ(code_with([](DecodeLimits& l) { l.max_planes = 11; }), Errc::kLimitExceeded);
  EXPECT_EQ(code_with([](DecodeLimits& l) { l.max_memory = 100000; }), Errc::kLimitExceeded);
  EXPECT_EQ(code_with([](DecodeLimits& l) { l.max_work = 1000; }), Errc::kLimitExceeded);
  EXPECT_EQ(code_with([](DecodeLimits& l) { l.max_stream_bytes = 100; }), Errc::kLimitExceeded);
}

/// A cube of 64^3 points with one value everywhere: some 200 bytes.
std::vector<std::uint8_t> cube_stream() {
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, 6};
  field.header.has_basis = false;
  field.header.num_functions = 2;
  for (std::int32_t z = 0; z < 64; ++z)
    for (std::int32_t y = 0; y < 64; ++y)
      for (std::int32_t x = 0; x < 64; ++x) field.positions.push_back({x, y, z});
  field.components.assign(field.num_points() * 6, 7);
  CodingParameters parameters;
  parameters.base_levels = 0;
  parameters.max_slice_points = kMostSlicePoints;
  parameters.index = parameters.digest = false;
  return *pack(field, parameters);
}

TEST(Spec_9_Level, ValuesAreNotBoundByBytes) {
  const auto stream = cube_stream();
  EXPECT_LT(stream.size(), 400u);  // of 1,572,864 values
  const auto units = split_units(stream);
  ASSERT_TRUE(units);
  for (const Unit& unit : units->units) EXPECT_NE(unit.type, UnitType::kFiller);
  EXPECT_TRUE(decode(stream));
}

TEST(Spec_9_Level, BoundsWhatAPartOfAStreamTakes) {
  const auto stream = cube_stream();
  DecodeOptions options;
  options.levels = 3;
  const auto coarse = decode(stream, options);
  ASSERT_TRUE(coarse) << to_string(coarse.error());
  EXPECT_EQ(coarse->num_points(), 512u);
  for (const int threads : {1, 2, 0}) {
    options = {};
    options.threads = threads;
    const auto cost = decode_cost(stream, options);
    ASSERT_TRUE(cost);
    EXPECT_LE(cost->memory, cost->memory_most);
    options.limits.max_memory = cost->memory_most;
    options.limits.max_work = cost->work;
    EXPECT_TRUE(decode(stream, options));
    --options.limits.max_memory;
    EXPECT_FALSE(decode(stream, options));
    options.limits.max_memory = cost->memory_most;
    --options.limits.max_work;
    EXPECT_FALSE(decode(stream, options));
  }
}

TEST(Spec_7_8_Metadata, ThatIsDamagedIsAnErrorOfDecodeToo) {
  const auto whole = small_stream(false);
  const auto units = split_units(whole);
  ASSERT_TRUE(units);
  std::vector<std::uint8_t> stream(kSignature.begin(), kSignature.end());
  for (const Unit& unit : units->units) {
    std::vector<std::uint8_t> payload(unit.payload.begin(), unit.payload.end());
    if (unit.type == UnitType::kMetadata) payload.resize(payload.size() / 2);
    append_unit(stream, unit.type, payload);
  }
  const auto decoded = decode(stream);
  ASSERT_FALSE(decoded);
  EXPECT_STREQ(decoded.error().element, "metadata_deflated");
}

TEST(Spec_7_8_Metadata, ComesBack) {
  const auto info = read_info(small_stream());
  ASSERT_TRUE(info);
  EXPECT_EQ(info->metadata, (Metadata{{"source", "test"}, {"empty", ""}}));
  EXPECT_TRUE(info->complete);
  EXPECT_EQ(info->header.grid.origin, (Vec3{0.5, -2, 1e6}));
  EXPECT_EQ(info->step[2], (std::array<std::uint32_t, 3>{16, 20, 24}));
  EXPECT_EQ(info->group, (std::vector<int>{0, 1, 1, 2}));
}

}  // namespace
}  // namespace slf::stream_hazards_test
