#include <gtest/gtest.h>

#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/sha256.h"
#include "bitstream/zlib_adapter.h"

namespace slf {
namespace {

struct SetCase {
  const char* name;
  SequenceParameterSet set;
};

SequenceParameterSet full_set() {
  SequenceParameterSet s;
  s.sps_grid_bits_minus1 = 20;
  s.sps_unit_grid_flag = 0;
  s.sps_origin = {-1, 2.5, 1e300};
  s.sps_step = 1e-9;
  s.sps_up_axis = 3;
  s.sps_left_handed_flag = s.sps_metres_flag = 1;
  s.sps_metres_per_unit = 0.001;
  s.sps_normal_bits = 12;
  s.sps_num_geometry_ranges_minus1 = 2;
  s.sps_geometry_range_end = {5, 20};
  s.sps_num_functions = 128;
  s.sps_basis_flag = 1;
  s.sps_order_minus1 = 3;
  s.sps_scales_theta = 4;
  s.sps_scales_gamma = 3;
  s.sps_colour_idc = s.sps_transfer_idc = s.sps_coefficient_coder = 1;
  s.sps_gamma_min = -90;
  s.sps_gamma_max = 127;
  s.sps_frame_idc = 1;
  s.sps_normal_cell_log2 = s.sps_grid_bits_minus1;
  s.sps_num_groups_minus1 = 2;
  s.sps_num_coefficient_ranges_minus1 = 1;
  s.sps_coefficient_range_end = {19};
  s.runs = {
      {0, 0, 6, 1, {1, 1, 1}}, {99, 1, 15, 0, {1, 2, (1u << 27) - 1}}, {26, 2, 0, 1, {77, 1, 1}}};
  return s;
}

SequenceParameterSet texture_set() {
  SequenceParameterSet s = full_set();
  s.sps_profile = kTextureProfile;
  s.sps_coefficient_coder = kTextureCoder;
  s.sps_texture_bits = 2;
  s.sps_texture_cell_log2 = 7;
  s.sps_num_coefficient_ranges_minus1 = 0;
  s.sps_coefficient_range_end = {};
  return s;
}

class SequenceParameterSetTest : public testing::TestWithParam<SetCase> {};

TEST_P(SequenceParameterSetTest, ParsesToWhatWasWritten) {
  const auto bytes = write_sequence_parameter_set(GetParam().set);
  const auto parsed = parse_sequence_parameter_set(bytes);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(write_sequence_parameter_set(*parsed), bytes);
  EXPECT_EQ(parsed->sps_origin, GetParam().set.sps_origin);
  EXPECT_EQ(parsed->runs.size(), GetParam().set.runs.size());
  EXPECT_EQ(parsed->sps_gamma_min, GetParam().set.sps_gamma_min);
  EXPECT_EQ(parsed->sps_normal_cell_log2, GetParam().set.sps_normal_cell_log2);
}

TEST_P(SequenceParameterSetTest, EveryTruncationIsReportedAndNothingIsReadPastTheEnd) {
  const auto whole = write_sequence_parameter_set(GetParam().set);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(),
                                        whole.begin() + static_cast<std::ptrdiff_t>(size));
    const auto parsed = parse_sequence_parameter_set(cut);
    ASSERT_FALSE(parsed) << size << " of " << whole.size() << " bytes";
    EXPECT_EQ(parsed.error().code, Errc::kTruncated);
    EXPECT_LE(parsed.error().bit_offset, size * 8);
  }
}

TEST_P(SequenceParameterSetTest, EveryFlippedBitGivesAValueOrAnError) {
  const auto whole = write_sequence_parameter_set(GetParam().set);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1 << bit % 8);
    const auto parsed = parse_sequence_parameter_set(damaged);
    if (parsed) {
      EXPECT_EQ(write_sequence_parameter_set(*parsed), damaged);
    } else {
      EXPECT_STRNE(parsed.error().element, "");
    }
  }
}

SequenceParameterSet cut_set() {
  SequenceParameterSet s = full_set();
  s.sps_base_levels = 5;
  s.sps_base_weight_minus1 = (1u << 22) - 1;
  s.sps_coefficient_range_end = {5};
  s.sps_cut_flag = s.sps_cut_slices_flag = 1;
  s.sps_cut_levels = 21;
  s.sps_cut_groups = 3;
  return s;
}

INSTANTIATE_TEST_SUITE_P(Spec_7_2, SequenceParameterSetTest,
                         testing::Values(SetCase{"geometry_alone", {}},
                                         SetCase{"everything", full_set()},
                                         SetCase{"base_and_cut", cut_set()},
                                         SetCase{"texture", texture_set()}),
                         [](const auto& set) { return set.param.name; });

TEST(Spec_3_3_BitReader, ExpGolombCodesAreThoseOfTheTable) {
  // 1, 010, 011, 00100, 00101: 0 .. 4
  const std::vector<std::uint8_t> bytes = {0b10100110, 0b01000010, 0b10000000};
  BitReader in(bytes);
  for (std::uint64_t expected = 0; expected <= 4; ++expected) EXPECT_EQ(in.ue("test"), expected);
  in.trailing_bits("test");
  EXPECT_TRUE(in.ok());
}

TEST(Spec_3_3_BitReader, SignedCodesComeBackAndAlternate) {
  BitWriter out;
  const std::vector<std::int64_t> values = {0, 1, -1, 2, -2, (1 << 30) - 1, 1 - (1 << 30)};
  for (const std::int64_t value : values) out.se(value);
  const auto bytes = out.take();
  EXPECT_EQ(bytes[0], 0b10100110);  // 1, 010, 011, 0...: the codes of 0, 1, 2
  BitReader in(bytes);
  for (const std::int64_t value : values) EXPECT_EQ(in.se("test"), value);
  EXPECT_TRUE(in.ok());
}

TEST(Spec_7_2_Texture, ProfileAndCoderGoTogether) {
  const auto error_of = [](const SequenceParameterSet& set) {
    const auto parsed = parse_sequence_parameter_set(write_sequence_parameter_set(set));
    return std::string(parsed ? "" : parsed.error().element);
  };
  EXPECT_EQ(error_of(texture_set()), "");
  SequenceParameterSet set = texture_set();
  set.sps_profile = 0;
  EXPECT_EQ(error_of(set), "sps_coefficient_coder");
  set = full_set();
  set.sps_profile = kTextureProfile;
  EXPECT_EQ(error_of(set), "sps_coefficient_coder");
  set = texture_set();
  set.sps_texture_bits = 3;
  EXPECT_EQ(error_of(set), "sps_texture_bits");
  set = texture_set();
  set.sps_geometry_coder = 1;
  EXPECT_EQ(error_of(set), "sps_geometry_coder");
  set = texture_set();
  set.sps_num_coefficient_ranges_minus1 = 1;
  set.sps_coefficient_range_end = {9};
  EXPECT_EQ(error_of(set), "sps_num_coefficient_ranges_minus1");
}

TEST(Spec_3_3_BitReader, ARunOfZerosFailsAndDoesNotSpin) {
  const std::vector<std::uint8_t> zeros(100, 0);
  BitReader in(zeros);
  in.ue("test");
  EXPECT_EQ(in.error().code, Errc::kOutOfRange);
  EXPECT_LE(in.bit_position(), 33u);
}

TEST(Spec_3_3_BitReader, TheFirstErrorSticks) {
  const std::vector<std::uint8_t> one = {0xFF};
  BitReader in(one);
  in.u(9, "first");
  in.u(1, "second");
  EXPECT_STREQ(in.error().element, "first");
}

TEST(Spec_3_3_BitReader, WhatFollowsAHeaderIsRefused) {
  const std::vector<std::uint8_t> zeros = {0, 0};
  BitReader longer(zeros);
  longer.u(4, "a");
  longer.trailing_bits("tail");
  EXPECT_EQ(longer.error().code, Errc::kOutOfRange);
  const std::vector<std::uint8_t> set = {0x01};
  BitReader nonzero(set);
  nonzero.u(4, "a");
  nonzero.trailing_bits("tail");
  EXPECT_EQ(nonzero.error().code, Errc::kReserved);
}

TEST(Spec_7_3_Slices, ParseToWhatWasWrittenAndEveryTruncationIsReported) {
  SequenceParameterSet set = cut_set();
  set.sps_base_weight_minus1 = 9;
  const SliceTable table{3, 1, {{0, 0}, {5, 700}, {70000, kMaxSlicePoints - 1}, {0, 8}}};
  const auto bytes = write_slice_table(table, set);
  const auto parsed = parse_slice_table(bytes, set);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(write_slice_table(*parsed, set), bytes);
  EXPECT_EQ(parsed->num_cells(), table.num_cells());
  EXPECT_EQ(parsed->num_points(), table.num_points());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto cut = parse_slice_table(std::span(bytes).first(size), set);
    ASSERT_FALSE(cut) << size;
    EXPECT_EQ(cut.error().code, Errc::kTruncated);
  }
}

TEST(Spec_7_3_Slices, CellsAreNoMoreThanPointsAndWeighAtMost2To24) {
  SequenceParameterSet set = cut_set();
  set.sps_base_weight_minus1 = 15;
  const auto element = [&](const SliceTable& table) -> std::string {
    const auto parsed = parse_slice_table(write_slice_table(table, set), set);
    return parsed ? "" : parsed.error().element;
  };
  EXPECT_EQ(element({0, 0, {{(1u << 20) - 1, (1u << 20) - 1}}}), "");
  EXPECT_EQ(element({0, 0, {{1u << 20, 1u << 20}}}), "slice_num_cells_minus1");
  EXPECT_EQ(element({0, 0, {{6, 5}}}), "slice_num_points_minus1");
  set.sps_base_levels = 0;
  EXPECT_EQ(element({1, 0, {{0, 5}, {0, 5}}}), "slices_num_minus1");
}

TEST(Spec_7_4_UnitHeaders, HaveASliceOnlyBelowTheBase) {
  const SequenceParameterSet set = cut_set();
  for (const UnitType type :
       {UnitType::kGeometry, UnitType::kCoefficients, UnitType::kNormals, UnitType::kDigest})
    for (const std::uint32_t range : {0u, 1u}) {
      SliceUnitHeader header{7, range, 0, {}};
      const bool ranged = type == UnitType::kGeometry || type == UnitType::kCoefficients;
      if (!ranged) header.range = 0;
      if (ranged && range == 0) header.slice_id = SliceUnitHeader::kBase;
      BitWriter out;
      WriteSyntax write{out};
      unit_ids(write, header, type, set);
      const auto bytes = out.take();
      BitReader in(bytes);
      ParseSyntax parse{in};
      SliceUnitHeader read;
      unit_ids(parse, read, type, set);
      EXPECT_EQ(read.slice_id, header.slice_id);
      EXPECT_EQ(read.range, header.range);
    }
}

TEST(Spec_7_7_Index, CountsAreBelievedOnlyIfTheBitsAreThere) {
  BitWriter out;
  out.ue(4000000000u);
  const auto entries = parse_index(out.take(), {});
  ASSERT_FALSE(entries);
  EXPECT_EQ(entries.error().code, Errc::kTruncated);
}

TEST(Spec_7_8_Metadata, RoundTripsAndRefusesEveryTruncation) {
  const Metadata metadata = {{"a", ""}, {"key", "value"}, {"übung", "größe"}};
  const auto bytes = write_metadata(metadata);
  ASSERT_TRUE(parse_metadata(bytes));
  EXPECT_EQ(*parse_metadata(bytes), metadata);
  EXPECT_TRUE(parse_metadata(write_metadata({})));
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_FALSE(parse_metadata(std::span(bytes).first(size))) << size;
}

TEST(Spec_7_8_Metadata, ABombIsNotInflated) {
  BitWriter out;
  out.ue(100u << 20);
  out.append(deflate(std::vector<std::uint8_t>(100u << 20, 0)));
  EXPECT_FALSE(parse_metadata(out.take()));
}

TEST(Sha256, MatchesFips180_4) {
  const auto hex = [](std::string_view text) {
    Sha256 sha;
    for (const char c : text) {  // byte by byte: every block boundary
      const auto byte = static_cast<std::uint8_t>(c);
      sha.update({&byte, 1});
    }
    std::string digits;
    for (const std::uint8_t byte : sha.finish())
      digits += "0123456789abcdef"[byte >> 4], digits += "0123456789abcdef"[byte & 15];
    return digits;
  };
  EXPECT_EQ(hex(""), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
  EXPECT_EQ(hex("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex("abcdbcdecdefdefgefghfghighijhijkijkljklmklmnlmnomnopnopq"),
            "248d6a61d20638b8e5c026930c3e6039a33ce45964ff2167f6ecedd419db06c1");
}

}  // namespace
}  // namespace slf
