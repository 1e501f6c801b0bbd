// SPDX-License-Identifier: Apache-2.0
// Limits count everything that is kept: units that say nothing, entries of an index, frames. In
// every function that reads a stream. Spec 9.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bitstream/units.h"
#include "codec/encoder/assemble.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/frames.h"
#include "slf/join_frames.h"
#include "slf/scene.h"
#include "slf/syntax_listing.h"
#include "slf/truncate.h"

namespace slf::kept_limits_test {
namespace {

using Stream = std::vector<std::uint8_t>;

Stream with_fillers(std::size_t count) {
  LightField field;
  field.header.grid = {{0, 0, 0}, 1, 1};
  field.header.has_basis = false;
  field.positions = {{0, 0, 0}, {1, 0, 1}};
  CodingParameters parameters;
  parameters.index = parameters.digest = false;
  const Stream packed = *pack(field, parameters);
  const Units units = *split_units(packed);
  Stream stream(packed.begin(),
                packed.begin() + static_cast<std::ptrdiff_t>(units.units.back().offset));
  for (std::size_t i = 0; i < count; ++i) append_unit(stream, UnitType::kFiller, {});
  append_unit(stream, UnitType::kEnd, end_payload(units.units.size() - 1 + count));
  return stream;
}

Stream moving() {
  std::ifstream file(std::filesystem::path(SLF_CONFORMANCE) / "streams/frames-groups/stream.slf",
                     std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The error of reading a stream within limits; nothing where there is none.
using Reader = std::function<std::optional<Errc>(const Stream&, const DecodeLimits&)>;

template <class Outcome>
std::optional<Errc> error_of(const Outcome& outcome) {
  return outcome ? std::nullopt : std::optional(outcome.error().code);
}

DecodeOptions options_within(const DecodeLimits& limits) {
  DecodeOptions options;
  options.limits = limits;
  return options;
}

const std::vector<std::pair<const char*, Reader>> kReaders = {
    {"decode", [](const auto& s, const auto& l) { return error_of(decode(s, options_within(l))); }},
    {"truncate",
     [](const auto& s, const auto& l) {
       DecodeOptions options = options_within(l);
       options.levels = 1;
       return error_of(truncate(s, options));
     }},
    {"read_info", [](const auto& s, const auto& l) { return error_of(read_info(s, l)); }},
    {"decode_cost",
     [](const auto& s, const auto& l) { return error_of(decode_cost(s, options_within(l))); }},
    {"list_syntax", [](const auto& s, const auto& l) { return error_of(list_syntax(s, l)); }},
    {"visit_syntax",
     [](const auto& s, const auto& l) {
       return error_of(visit_syntax(s, l, [](const ListedUnit&) { return true; }));
     }},
    {"list_frames", [](const auto& s, const auto& l) { return error_of(list_frames(s, l)); }},
    {"FrameDecoder", [](const auto& s, const auto& l) {
       return error_of(FrameDecoder::open(s, options_within(l)));
     }}};

DecodeLimits within(std::uint64_t bytes) {
  DecodeLimits limits;
  limits.max_memory = bytes;
  return limits;
}

TEST(Spec_9_Limits, CountUnitsThatSayNothingInEveryReader) {
  constexpr std::size_t kUnits = 4000;
  const Stream stream = with_fillers(kUnits);
  for (const auto& [name, read] : kReaders) {
    EXPECT_EQ(read(stream, within(kMemoryOfUnit * kUnits)), Errc::kLimitExceeded) << name;
    EXPECT_EQ(read(stream, within(4 * kMemoryOfUnit * kUnits)), std::nullopt) << name;
  }
}

TEST(Spec_9_Limits, CountUnitsOfPartsThatAreMerged) {
  constexpr std::size_t kUnits = 4000;
  const std::vector<PartStream> parts = {{"a.slf", with_fillers(kUnits)}};
  const auto refused = merge_parts(parts, true, 1, within(kMemoryOfUnit * kUnits));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimitExceeded) << refused.error().message;
  EXPECT_EQ(refused.error().message.find("a.slf: "), 0u) << refused.error().message;
  const auto read = merge_parts(parts, true, 1, within(4 * kMemoryOfUnit * kUnits));
  ASSERT_FALSE(read);  // it is no part
  EXPECT_EQ(read.error().code, Errc::kInvalidInput) << read.error().message;
}

TEST(Spec_9_Limits, CountFramesInEveryReader) {
  const Stream stream = moving();
  ASSERT_GT(list_frames(stream)->size(), 2u);
  for (const auto& [name, read] : kReaders) {
    EXPECT_EQ(read(stream, within(500)), Errc::kLimitExceeded) << name;
    EXPECT_EQ(read(stream, within(1 << 26)), std::nullopt) << name;
  }
  const auto cut = truncate_frames(stream, 0, 0, options_within(within(500)));
  EXPECT_EQ(error_of(cut), Errc::kLimitExceeded);
  const std::vector<PartStream> parts = {{"a.slf", stream}};
  const auto refused = join_frames(parts, JoinOrder::kAsGiven, within(500));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kLimitExceeded);
  EXPECT_EQ(refused.error().message.find("a.slf: "), 0u) << refused.error().message;
  EXPECT_TRUE(join_frames(parts, JoinOrder::kAsGiven, within(1 << 20)));
}

TEST(Spec_9_Limits, CountFramesOfAllPartsTogether) {
  const Stream stream = moving();
  std::uint64_t least = 1;  // that is enough for one
  while (!join_frames(std::vector<PartStream>{{"a", stream}}, JoinOrder::kAsGiven, within(least)))
    least *= 2;
  const std::vector<PartStream> parts(4, {"a", stream});
  EXPECT_FALSE(join_frames(parts, JoinOrder::kAsGiven, within(least)));
  EXPECT_TRUE(join_frames(parts, JoinOrder::kAsGiven, within(8 * least)));
}

}  // namespace
}  // namespace slf::kept_limits_test
