// SPDX-License-Identifier: Apache-2.0
#include "bitstream/parameter_sets.h"

#include <array>

#include "bitstream/checked_syntax.h"
#include "bitstream/unchecked_headers.h"

namespace slf {
namespace {

/// By bit of the word, the most significant first.
constexpr std::array<const char*, 32> kFeatures = {
    "sps_feature[0]",  "sps_feature[1]",  "sps_feature[2]",  "sps_feature[3]",  "sps_feature[4]",
    "sps_feature[5]",  "sps_feature[6]",  "sps_feature[7]",  "sps_feature[8]",  "sps_feature[9]",
    "sps_feature[10]", "sps_feature[11]", "sps_feature[12]", "sps_feature[13]", "sps_feature[14]",
    "sps_feature[15]", "sps_feature[16]", "sps_feature[17]", "sps_feature[18]", "sps_feature[19]",
    "sps_feature[20]", "sps_feature[21]", "sps_feature[22]", "sps_feature[23]", "sps_feature[24]",
    "sps_feature[25]", "sps_feature[26]", "sps_feature[27]", "sps_feature[28]", "sps_feature[29]",
    "sps_feature[30]", "sps_feature[31]"};

constexpr std::uint64_t kMostExtensionBytes = 1 << 16;

/// The element that does not go with the plane table; nullptr: none. Every group has a function.
const char* broken_rule(const SequenceParameterSet& set) {
  std::uint32_t used = 0;  // groups, by bit
  for (const PlaneRun& run : set.runs) used |= 1u << run.sps_plane_group;
  if (used + 1 != 1u << set.num_groups()) return "sps_num_groups_minus1";
  if (set.sps_cut_groups > set.num_groups()) return "sps_cut_groups";
  return nullptr;
}

}  // namespace

void later_elements(ParseSyntax& parse, SequenceParameterSet& set) {
  parse.in.align("sps_trailing_bits");
  if (!parse.ok() || parse.in.bits_left() == 0) return;
  set.features = 0;
  for (std::size_t i = 0; i < kFeatures.size(); ++i) {
    const std::uint32_t bit = 1u << (31 - i);
    std::uint32_t flag = 0;
    parse.u(1, kFeatures[i], flag, (kKnownFeatures & bit) != 0 ? Range{0, 1} : defined(0, 0));
    if (flag != 0) set.features |= bit;
  }
  if (parse.in.bits_left() > 8 * kMostExtensionBytes)
    parse.in.fail(Errc::kOutOfRange, "sps_extension");
}

Result<SequenceParameterSet> parse_sequence_parameter_set(std::span<const std::uint8_t> payload) {
  BitReader in(payload);
  ParseSyntax parse{in};
  SequenceParameterSet set;
  sequence_parameter_set(parse, set);
  later_elements(parse, set);
  if (!in.ok()) return in.error();
  if (const char* element = broken_rule(set)) return Error{Errc::kOutOfRange, element};
  return set;
}

Result<Done, InputError> check_sequence_parameter_set(const SequenceParameterSet& set) {
  CheckSyntax check;
  sequence_parameter_set(check, set);
  if (const char* element = check.ok() ? broken_rule(set) : nullptr)
    check.require(false, Errc::kOutOfRange, element);
  check.require((set.features & ~kKnownFeatures) == 0, Errc::kUnsupported, "sps_feature");
  if (!check.ok()) return refusal(check);
  return Done{};
}

Result<std::vector<std::uint8_t>, InputError> write_sequence_parameter_set(
    const SequenceParameterSet& set) {
  SLF_CHECK(check_sequence_parameter_set(set));
  return sequence_as_is(set);
}

std::vector<std::uint8_t> sequence_as_is(const SequenceParameterSet& set) {
  auto payload = header_as_is([&](auto& v) { sequence_parameter_set(v, set); });
  for (int shift = 24; set.features != 0 && shift >= 0; shift -= 8)
    payload.push_back(static_cast<std::uint8_t>(set.features >> shift));
  return payload;
}

}  // namespace slf
