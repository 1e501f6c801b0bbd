// SPDX-License-Identifier: Apache-2.0
// What a later version may add, as a reader of this version meets it. Spec 7.1.1, 7.1.2, 7.2.1.
#include <gtest/gtest.h>

#include <algorithm>

#include "bitstream/index.h"
#include "bitstream/unchecked_headers.h"
#include "bitstream/units.h"
#include "codec/encoder/assemble.h"
#include "codec/stream/stream_pieces.h"
#include "conformance/edit_units.h"
#include "slf/decoder.h"
#include "slf/syntax_listing.h"
#include "slf/truncate.h"
#include "tests/fuzz/fuzz.h"

namespace slf::growth_test {
namespace {

using conformance::base_stream;
using conformance::Bytes;
using conformance::edited;
using conformance::UnitList;

const Bytes kPayload = {'E', 'X', 'A', 'M', 9, 9};

Bytes with_unit(int type) {
  return edited([&](UnitList& units) {
    units.insert(units.end() - 2, {static_cast<UnitType>(type), kPayload});
  });
}

Bytes with_later_elements(const Bytes& elements) {
  return edited([&](UnitList& units) {
    units[0].payload.insert(units[0].payload.end(), elements.begin(), elements.end());
  });
}

bool is_named(int type) { return (type >= 1 && type <= 11) || type == 14 || type == 15; }

TEST(Spec_7_1_1_UnitTypes, BitSixOfTheTypeSaysWhetherAReaderGoesOn) {
  for (int type = 0; type < 256; ++type) {
    if (is_named(type)) continue;
    const auto decoded = decode(with_unit(type));
    EXPECT_EQ(bool(decoded), (type & 64) != 0) << type;
    if (decoded) continue;
    EXPECT_EQ(decoded.error().code, Errc::kUnsupported) << type;
    EXPECT_EQ(decoded.error().unit, "type " + std::to_string(type));
  }
}

TEST(Spec_7_1_1_UnitTypes, ThatMayBeSkippedAreListedAndCutWithTheirPayload) {
  const auto stream = with_unit(200);
  const auto has_payload = [](const Bytes& bytes) {
    const auto units = split_units(bytes);
    const Unit* unit = units ? units->first(static_cast<UnitType>(200)) : nullptr;
    return unit != nullptr && std::equal(kPayload.begin(), kPayload.end(), unit->payload.begin());
  };
  const auto listed = list_syntax(stream);
  ASSERT_TRUE(listed);
  const auto unit = listed->end() - 3;
  EXPECT_EQ(unit->type, "type 200");
  EXPECT_EQ(unit->elements[0].name, "unit_payload");
  DecodeOptions coarse;
  coarse.levels = 2;
  const auto cut = truncate(stream, coarse);
  ASSERT_TRUE(cut);
  EXPECT_LT(cut->size(), stream.size());
  EXPECT_TRUE(has_payload(*cut));
}

/// A stream whose index lists one more unit.
Bytes indexed_with_unit(int type) {
  const Bytes stream = base_stream(true);
  const Units split = *split_units(stream);
  const SequenceParameterSet set = *parse_sequence_parameter_set(split.units[0].payload);
  std::vector<CodedUnit> units;
  for (const Unit& unit : split.units) {
    if (unit.type == UnitType::kSequence || unit.type == UnitType::kIndex ||
        unit.type == UnitType::kEnd)
      continue;
    const auto ids = has_ids(unit.type) ? *read_ids(unit, set) : SliceUnitHeader{};
    units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}, ids});
  }
  units.push_back({static_cast<UnitType>(type), kPayload, {}});
  return *assemble(set, units, (*find_index(split, set))->boxes);
}

TEST(Spec_7_1_1_UnitTypes, AreRefusedWhereTheIndexAloneShowsThem) {
  for (const int type : {29, 93}) {
    const Bytes stream = indexed_with_unit(type);
    const auto head = find_head(stream, stream.size(), DecodeLimits{}.max_memory);
    ASSERT_TRUE(head && *head);
    ASSERT_LT((*head)->bytes, stream.size());
    DecodeOptions coarse;
    coarse.levels = 3;
    const auto plan = plan_read(std::span(stream).first(static_cast<std::size_t>((*head)->bytes)),
                                stream.size(), coarse);
    const std::string refused = plan ? "" : to_string(plan.error().code);
    EXPECT_EQ(refused, type == 93 ? "" : "kUnsupported");
  }
}

TEST(Spec_7_1_2_Version, IsLookedAtBeforeAnythingElse) {
  const Bytes whole = base_stream(true);
  for (int major = 0; major < 256; ++major)
    for (const int minor : {0, 1, 255}) {
      Bytes stream(whole.begin(), whole.begin() + 11);
      stream[9] = static_cast<std::uint8_t>(major);
      stream[10] = static_cast<std::uint8_t>(minor);
      const auto decoded = decode(stream);
      ASSERT_FALSE(decoded);
      const bool known = major == kVersionMajor;
      EXPECT_EQ(decoded.error().code, known ? Errc::kTruncated : Errc::kUnsupported);
    }
}

TEST(Spec_7_1_2_Version, IsThatOfTheWriterInWhatIsCut) {
  Bytes later = base_stream(true);
  later[10] = 200;
  EXPECT_EQ(decode(later).error().code, Errc::kChecksum);  // which is of the version, too
  later = fuzz::with_sound_crcs(later);
  EXPECT_EQ(read_info(later)->version_minor, 200);
  EXPECT_EQ(read_info(*truncate(later, {}))->version_minor, 0);
}

TEST(Spec_7_2_1_Features, ThoseThatAreKnownAreReadWrittenAndGivenTheirVersion) {
  SequenceParameterSet set =
      *parse_sequence_parameter_set(read_unit(base_stream(false), kSignature.size())->payload);
  EXPECT_EQ(set.features, 0u);
  EXPECT_EQ(set.version_minor(), 0);
  const std::size_t before = sequence_as_is(set).size();
  set.features = kReferenceContexts;
  EXPECT_EQ(set.version_minor(), 1);
  const Bytes payload = sequence_as_is(set);
  EXPECT_EQ(payload.size(), before + 4);
  const auto again = parse_sequence_parameter_set(payload);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->features, kReferenceContexts);
  EXPECT_TRUE(again->has_reference_contexts());
  EXPECT_FALSE(again->is_empty_frame());
  set.features = kEmptyFrame;
  EXPECT_EQ(set.version_minor(), 2);
  EXPECT_TRUE(parse_sequence_parameter_set(sequence_as_is(set))->is_empty_frame());
  set.features = kReferenceContexts | kMovedPoints;
  EXPECT_EQ(set.version_minor(), 3);
  EXPECT_TRUE(parse_sequence_parameter_set(sequence_as_is(set))->has_moved_points());
}

TEST(Spec_7_2_1_Features, EveryOtherIsUnsupportedByItsNumber) {
  for (int feature = 0; feature < 32; ++feature) {
    if ((kKnownFeatures >> (31 - feature) & 1) != 0) continue;
    Bytes word(4);
    word[static_cast<std::size_t>(feature / 8)] = static_cast<std::uint8_t>(0x80 >> feature % 8);
    for (const Error& error : {decode(with_later_elements(word)).error(),
                               read_info(with_later_elements(word)).error()}) {
      EXPECT_EQ(error.code, Errc::kUnsupported);
      EXPECT_EQ(error.element, "sps_feature[" + std::to_string(feature) + "]");
    }
  }
}

TEST(Spec_7_2_1_Extension, IsSkippedWhateverIsInIt) {
  const auto plain = decode(base_stream(false));
  ASSERT_TRUE(plain);
  for (const std::size_t bytes : {0u, 1u, 100u, 1u << 16}) {
    Bytes elements(4 + bytes, 0xFF);
    std::fill_n(elements.begin(), 4, std::uint8_t{0});
    const auto decoded = decode(with_later_elements(elements));
    ASSERT_TRUE(decoded) << to_string(decoded.error());
    EXPECT_EQ(decoded->components, plain->components);
  }
}

TEST(Spec_7_2_1_Extension, IsListedAndLeftOutOfWhatIsCut) {
  const Bytes stream = with_later_elements({0, 0, 0, 0, 0xAB, 0xCD});
  const auto listed = list_syntax(stream);
  ASSERT_TRUE(listed);
  EXPECT_EQ(listed->front().elements.back().name, "sps_extension");
  EXPECT_EQ(listed->front().elements.back().bits, 16u);
  EXPECT_EQ(*truncate(stream, {}), *truncate(base_stream(false), {}));
}

TEST(Spec_7_2_1_Extension, CutShortOrTooLongIsAnError) {
  const Bytes most(4 + (1 << 16) + 1, 0);
  for (const std::size_t bytes : {std::size_t{1}, std::size_t{2}, std::size_t{3}, most.size()}) {
    const auto decoded =
        decode(with_later_elements(Bytes(most.begin(), most.begin() + std::ptrdiff_t(bytes))));
    ASSERT_FALSE(decoded) << bytes;
    EXPECT_EQ(decoded.error().code, bytes < 4 ? Errc::kTruncated : Errc::kOutOfRange);
  }
}

}  // namespace
}  // namespace slf::growth_test
