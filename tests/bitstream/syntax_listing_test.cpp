// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "slf/encoder.h"
#include "slf/syntax_listing.h"
#include "tests/codec/field_support.h"

namespace slf::syntax_listing_test {
namespace {

std::vector<std::uint8_t> stream_of_all_units() {
  LightField field = test::make_field(test::sphere_cloud(5), 5, 4);
  CodingParameters parameters;
  parameters.base_levels = 2;
  parameters.max_slice_points = 600;
  parameters.transform = TransformMode::kFunctions;
  parameters.metadata = {{"source", "a test"}};
  const auto stream = pack(field, parameters);
  EXPECT_TRUE(stream) << (stream ? "" : stream.error().message);
  return *stream;
}

// Clause 7: nothing stands between two elements but the zero bits before a codeword, and nothing
// before the first and behind the last but type, length and checksum. Clause 7.1.2: the version.
TEST(SyntaxListing, ElementsFillEveryUnit) {
  const auto stream = stream_of_all_units();
  const auto units = list_syntax(stream);
  ASSERT_TRUE(units) << to_string(units.error());
  std::uint64_t next_unit = 8;
  for (const ListedUnit& unit : *units) {
    EXPECT_EQ(unit.offset, next_unit);
    next_unit = unit.offset + unit.bytes;
    ASSERT_FALSE(unit.elements.empty()) << unit.type;
    const std::uint64_t length_bytes = unit.elements.front().bit / 8 - unit.offset - 1;
    // That of a sequence unit stands behind the version, and is one byte here.
    const std::uint64_t least = unit.type == "sequence" ? 0 : 1;
    EXPECT_TRUE(length_bytes >= least && length_bytes <= 6 * least) << unit.type;
    std::uint64_t bit = unit.elements.front().bit;
    for (const ListedElement& element : unit.elements) {
      if (element.kind == "bytes") bit = (bit + 7) / 8 * 8;
      if (element.name == "sps_profile") bit += 8;
      EXPECT_EQ(element.bit, bit) << unit.type << " " << element.name;
      bit = element.bit + element.bits;
    }
    EXPECT_EQ((bit + 7) / 8 + 4, unit.offset + unit.bytes) << unit.type;
  }
  EXPECT_EQ(next_unit, stream.size());
}

TEST(SyntaxListing, ValuesAreThoseOfTheHeaders) {
  const auto stream = stream_of_all_units();
  const auto units = list_syntax(stream);
  ASSERT_TRUE(units) << to_string(units.error());
  const auto value = [&](const std::string& name) {
    for (const ListedUnit& unit : *units)
      for (const ListedElement& element : unit.elements)
        if (element.name == name) return element.value;
    return std::string("not there");
  };
  EXPECT_EQ(value("sps_grid_bits_minus1"), "4");
  EXPECT_EQ(value("sps_base_levels"), "2");
  EXPECT_EQ(value("sps_num_functions"), "4");
  EXPECT_EQ(value("end_num_units"), std::to_string(units->size() - 1));
}

// Clause 7.6: zero bits lead to the byte on which textures( ) begins.
TEST(SyntaxListing, TexturesBeginOnAByte) {
  std::ifstream file(SLF_CONFORMANCE "/streams/texture-12/stream.slf", std::ios::binary);
  const std::vector<std::uint8_t> stream(std::istreambuf_iterator<char>(file), {});
  const auto units = list_syntax(stream);
  ASSERT_TRUE(units) << to_string(units.error());
  int textures = 0;
  for (const ListedUnit& unit : *units)
    for (std::size_t e = 1; e < unit.elements.size(); ++e)
      if (unit.elements[e - 1].name == "plane_group") {
        EXPECT_EQ(unit.elements[e].name, "tx_picture_flag");
        EXPECT_EQ(unit.elements[e].value, "1");
        EXPECT_EQ(unit.elements[e].bit % 8, 0u);
        ++textures;
      }
  EXPECT_EQ(textures, 2);
}

TEST(SyntaxListing, ADamagedStreamGivesTheErrorOfTheDecoder) {
  const auto stream = stream_of_all_units();
  const auto cut = list_syntax(std::span(stream).first(stream.size() - 1));
  ASSERT_FALSE(cut);
  EXPECT_STREQ(cut.error().element, "unit_payload");
}

}  // namespace
}  // namespace slf::syntax_listing_test
