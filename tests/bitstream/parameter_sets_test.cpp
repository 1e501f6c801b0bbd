// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "bitstream/encoder/deflate.h"
#include "bitstream/index.h"
#include "bitstream/metadata.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/unchecked_headers.h"
#include "tests/bitstream/header_sets.h"

namespace slf::parameter_sets_test {
namespace {

using namespace header_sets;

struct SetCase {
  const char* name;
  SequenceParameterSet set;
};
void PrintTo(const SetCase& c, std::ostream* out) { *out << c.name; }

class SequenceParameterSetTest : public testing::TestWithParam<SetCase> {};

TEST_P(SequenceParameterSetTest, ParsesToWhatWasWritten) {
  const auto bytes = sequence_as_is(GetParam().set);
  const auto parsed = parse_sequence_parameter_set(bytes);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(sequence_as_is(*parsed), bytes);
  EXPECT_EQ(parsed->sps_origin, GetParam().set.sps_origin);
  EXPECT_EQ(parsed->runs.size(), GetParam().set.runs.size());
  EXPECT_EQ(parsed->sps_gamma_min, GetParam().set.sps_gamma_min);
  EXPECT_EQ(parsed->sps_normal_cell_log2, GetParam().set.sps_normal_cell_log2);
}

TEST_P(SequenceParameterSetTest, EveryTruncationIsReportedAndNothingIsReadPastTheEnd) {
  const auto whole = sequence_as_is(GetParam().set);
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
  const auto whole = sequence_as_is(GetParam().set);
  for (std::size_t bit = 0; bit < 8 * whole.size(); ++bit) {
    auto damaged = whole;
    damaged[bit / 8] = static_cast<std::uint8_t>(damaged[bit / 8] ^ 1 << bit % 8);
    const auto parsed = parse_sequence_parameter_set(damaged);
    if (parsed) {
      EXPECT_EQ(sequence_as_is(*parsed), damaged);
    } else {
      EXPECT_STRNE(parsed.error().element, "");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_7_2, SequenceParameterSetTest,
                         testing::Values(SetCase{"geometry_alone", {}},
                                         SetCase{"everything", full_set()},
                                         SetCase{"base_and_cut", cut_set()},
                                         SetCase{"texture", texture_set()},
                                         SetCase{"layered", layered_set()}),
                         [](const auto& set) { return set.param.name; });

/// The element that a reader of the written set would refuse; "" for none.
std::string refused_by_reader(const SequenceParameterSet& set) {
  const auto parsed = parse_sequence_parameter_set(sequence_as_is(set));
  return parsed ? "" : parsed.error().element;
}

std::string refused_by_writer(const SequenceParameterSet& set) {
  CheckSyntax check;
  sequence_parameter_set(check, set);
  return check.ok() ? "" : check.element;
}

TEST_P(SequenceParameterSetTest, IsFoundGoodBeforeItIsWritten) {
  EXPECT_EQ(refused_by_writer(GetParam().set), "");
}

TEST(Spec_7_2_Sequence, IsRefusedBeforeItIsWrittenWhereAReaderWouldRefuseIt) {
  using Set = SequenceParameterSet;
  const std::vector<std::function<void(Set&)>> edits = {
      [](Set& s) { s.sps_profile = 3; },
      [](Set& s) { s.sps_grid_bits_minus1 = 21; },
      [](Set& s) { s.sps_step = 0; },
      [](Set& s) { s.sps_origin[1] = std::numeric_limits<double>::infinity(); },
      [](Set& s) { s.sps_up_axis = 7; },
      [](Set& s) { s.sps_metres_per_unit = -1; },
      [](Set& s) { s.sps_geometry_coder = 1; },
      [](Set& s) { s.sps_normal_bits = 3; },
      [](Set& s) { s.sps_normal_bits = 13; },
      [](Set& s) { s.sps_base_levels = 21; },
      [](Set& s) { s.sps_base_levels = 4; },
      [](Set& s) {
        s.sps_geometry_range_end = {20, 5};
      },
      [](Set& s) { s.sps_num_functions = 4097; },
      [](Set& s) { s.sps_basis_idc = 2; },
      [](Set& s) { s.sps_scales_theta = 7; },
      [](Set& s) { s.sps_scales_gamma = 2; },
      [](Set& s) { s.sps_gamma_min = -128; },
      [](Set& s) { s.sps_gamma_max = -91; },
      [](Set& s) { s.sps_coefficient_coder = kTextureCoder; },
      [](Set& s) { s.sps_num_groups_minus1 = 1; },
      [](Set& s) { s.runs[1].sps_run_length_minus1 = 200; },
      [](Set& s) { s.runs[1].sps_plane_step[2] = 1u << 27; }};
  for (std::size_t i = 0; i < edits.size(); ++i) {
    SequenceParameterSet set = full_set();
    edits[i](set);
    EXPECT_NE(refused_by_writer(set), "") << i;
    EXPECT_EQ(refused_by_writer(set), refused_by_reader(set)) << i;
  }
}

TEST(Spec_7_2_Layers, AreOfEveryGroupAndTheirCutLeavesOneOut) {
  const auto parsed = parse_sequence_parameter_set(sequence_as_is(layered_set()));
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(parsed->sps_num_layers_minus1, layered_set().sps_num_layers_minus1);
  EXPECT_EQ(parsed->num_layers(), 4u);
  EXPECT_EQ(parsed->layers_of(1), 1u);
  EXPECT_EQ(parsed->kept_layers(), 3u);
  SequenceParameterSet set = layered_set();
  set.sps_num_layers_minus1 = {2, 0, 2};
  const auto refused = parse_sequence_parameter_set(sequence_as_is(set));
  ASSERT_FALSE(refused);
  EXPECT_STREQ(refused.error().element, "sps_cut_layers");
}

TEST(Spec_7_2_Texture, ProfileAndCoderGoTogether) {
  EXPECT_EQ(refused_by_reader(texture_set()), "");
  SequenceParameterSet set = texture_set();
  set.sps_profile = 0;
  EXPECT_EQ(refused_by_reader(set), "sps_coefficient_coder");
  set = full_set();
  set.sps_profile = kTextureProfile;
  EXPECT_EQ(refused_by_reader(set), "sps_coefficient_coder");
  set = texture_set();
  set.sps_texture_bits = 3;
  EXPECT_EQ(refused_by_reader(set), "sps_texture_bits");
  set = texture_set();
  set.sps_geometry_coder = 1;
  EXPECT_EQ(refused_by_reader(set), "sps_geometry_coder");
  set = texture_set();
  set.sps_num_coefficient_ranges_minus1 = 1;
  set.sps_coefficient_range_end = {9};
  EXPECT_EQ(refused_by_reader(set), "sps_num_coefficient_ranges_minus1");
}

TEST(Spec_7_3_Slices, ParseToWhatWasWrittenAndEveryTruncationIsReported) {
  SequenceParameterSet set = cut_set();
  const SliceTable table{3, 1, {{0, 0}, {5, 700}, {70000, kMaxSlicePoints - 1}, {0, 8}}};
  const auto bytes = slice_table_as_is(table, set);
  const auto parsed = parse_slice_table(bytes, set);
  ASSERT_TRUE(parsed) << to_string(parsed.error());
  EXPECT_EQ(slice_table_as_is(*parsed, set), bytes);
  EXPECT_EQ(parsed->num_cells(), table.num_cells());
  EXPECT_EQ(parsed->num_points(), table.num_points());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto cut = parse_slice_table(std::span(bytes).first(size), set);
    ASSERT_FALSE(cut) << size;
    EXPECT_EQ(cut.error().code, Errc::kTruncated);
  }
}

TEST(Spec_7_3_Slices, CellsAreNoMoreThanPointsAnd2To22Together) {
  SequenceParameterSet set = cut_set();
  const auto element = [&](const SliceTable& table) -> std::string {
    const auto parsed = parse_slice_table(slice_table_as_is(table, set), set);
    return parsed ? "" : parsed.error().element;
  };
  EXPECT_EQ(element({0, 0, {{kMaxCells - 1, kMaxCells - 1}}}), "");
  EXPECT_EQ(element({1, 0, {{kMaxCells - 1, kMaxCells - 1}, {0, 0}}}), "slice_num_cells_minus1");
  EXPECT_EQ(element({0, 0, {{6, 5}}}), "slice_num_points_minus1");
  set.sps_base_levels = 0;
  EXPECT_EQ(element({1, 0, {{0, 5}, {0, 5}}}), "slices_num_minus1");
}

TEST(Spec_7_4_UnitHeaders, HaveASliceOnlyBelowTheBase) {
  const SequenceParameterSet set = cut_set();
  for (const UnitType type : {UnitType::kGeometry, UnitType::kCoefficients, UnitType::kRefinement,
                              UnitType::kNormals, UnitType::kDigest})
    for (const std::uint32_t range : {0u, 1u}) {
      SliceUnitHeader header{7, range, 0, type == UnitType::kRefinement ? 2u : 0u, {}};
      const bool ranged = type == UnitType::kGeometry || has_values(type);
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
      EXPECT_EQ(read.layer, header.layer);
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

}  // namespace
}  // namespace slf::parameter_sets_test
