// SPDX-License-Identifier: Apache-2.0
#include "attributes/video/hevc_stream.h"

#include <algorithm>
#include <array>
#include <bit>

#include "attributes/video/hevc_references.h"
#include "base/error_place.h"
#include "bitstream/bit_reader.h"

namespace slf {
namespace {

using Bytes = std::span<const std::uint8_t>;

constexpr std::size_t kHeaderBytes = 2;
constexpr std::size_t kMostUnitBytes = 0x7FFFFFFF;  // libde265 counts in int
constexpr std::size_t kMostHeaderBytes = 1024;  // of a slice, to its references: 49 of 80 bits each
constexpr int kMostPadding = 63;  // samples of the coded size beyond the window: the largest block

// nal_unit_type, H.265 table 7-1.
constexpr int kLastTrailing = 9;  // 0 .. 9: trailing and leading pictures
constexpr int kFirstRandomAccess = 16, kLastRandomAccess = 21;
constexpr int kVps = 32, kSps = 33, kPps = 34;
constexpr int kDelimiter = 35, kFiller = 38, kPrefixSei = 39, kSuffixSei = 40;

int unit_type(Bytes unit) { return unit[0] >> 1 & 63; }

bool is_picture(int type) {
  return type <= kLastTrailing || (type >= kFirstRandomAccess && type <= kLastRandomAccess);
}

bool is_skipped(int type) {
  return type == kDelimiter || type == kFiller || type == kPrefixSei || type == kSuffixSei;
}

/// First 00 00 01 at or after `from`; the stream's size where there is none.
std::size_t start_code(Bytes stream, std::size_t from) {
  static constexpr std::array<std::uint8_t, 3> kCode = {0, 0, 1};
  const auto at = std::search(stream.begin() + static_cast<std::ptrdiff_t>(from), stream.end(),
                              kCode.begin(), kCode.end());
  return static_cast<std::size_t>(at - stream.begin());
}

/// Without emulation prevention bytes: 00 00 03 stands for 00 00. H.265 7.3.1.1.
std::vector<std::uint8_t> raw_payload(Bytes unit, std::size_t most = SIZE_MAX) {
  std::vector<std::uint8_t> raw;
  int zeros = 0;
  for (const std::uint8_t byte : unit.subspan(kHeaderBytes)) {
    if (zeros >= 2 && byte == 3) {
      zeros = 0;
      continue;
    }
    if (raw.size() == most) break;
    zeros = byte == 0 ? zeros + 1 : 0;
    raw.push_back(byte);
  }
  return raw;
}

/// H.265 7.3.3, with profile_present_flag 1.
void skip_profile_tier_level(BitReader& in, int sub_layers_minus1) {
  constexpr int kProfileBits = 88, kLevelBits = 8;
  const auto skip = [&in](int bits) {
    for (; bits > 0; bits -= 8) in.u(8, "profile_tier_level");
  };
  skip(kProfileBits + kLevelBits);
  std::array<int, 8> present{};  // bits of each sub-layer
  for (std::size_t i = 0; i < static_cast<std::size_t>(sub_layers_minus1); ++i) {
    if (in.u(1, "profile_tier_level") != 0) present[i] += kProfileBits;
    if (in.u(1, "profile_tier_level") != 0) present[i] += kLevelBits;
  }
  if (sub_layers_minus1 > 0) in.u((8 - sub_layers_minus1) * 2, "profile_tier_level");
  for (const int bits : present) skip(bits);
}

/// The coded size less the window is the expected size. `window` in samples.
bool size_matches(std::uint64_t coded, std::uint64_t window, int expected) {
  const auto size = static_cast<std::uint64_t>(expected);
  return coded >= size && coded <= size + kMostPadding && window == coded - size;
}

/// An element that has to have one value.
void expect(BitReader& in, std::uint64_t value, std::uint64_t expected, const char* element) {
  if (value != expected) in.fail(Errc::kOutOfRange, element);
}

/// @return coded width and height
std::array<std::uint64_t, 2> check_picture_format(BitReader& in, const HevcFormat& expected) {
  const auto chroma = static_cast<std::uint64_t>(expected.chroma);
  expect(in, in.ue("chroma_format_idc"), chroma, "chroma_format_idc");
  if (chroma == 3)
    expect(in, in.u(1, "separate_colour_plane_flag"), 0, "separate_colour_plane_flag");
  const std::uint64_t width = in.ue("pic_width_in_luma_samples");
  const std::uint64_t height = in.ue("pic_height_in_luma_samples");
  std::array<std::uint64_t, 4> window{};  // left, right, top, bottom
  if (in.u(1, "conformance_window_flag") != 0)
    for (auto& offset : window) offset = in.ue("conf_win_offset");
  const std::uint64_t unit = expected.chroma == ChromaFormat::k420 ? 2 : 1;
  if (!size_matches(width, (window[0] + window[1]) * unit, expected.width))
    in.fail(Errc::kOutOfRange, "pic_width_in_luma_samples");
  if (!size_matches(height, (window[2] + window[3]) * unit, expected.height))
    in.fail(Errc::kOutOfRange, "pic_height_in_luma_samples");
  const auto depth = static_cast<std::uint64_t>(expected.bits - 8);
  expect(in, in.ue("bit_depth_luma_minus8"), depth, "bit_depth_luma_minus8");
  expect(in, in.ue("bit_depth_chroma_minus8"), depth, "bit_depth_chroma_minus8");
  return {width, height};
}

/// Sizes of blocks: what libde265 would otherwise complain of on standard error.
/// @return log2 of the largest
int check_blocks(BitReader& in) {
  const std::uint64_t coding_min = in.ue("log2_min_luma_coding_block_size_minus3") + 3;
  const std::uint64_t coding_max = coding_min + in.ue("log2_diff_max_min_luma_coding_block_size");
  const std::uint64_t transform_min = in.ue("log2_min_luma_transform_block_size_minus2") + 2;
  const std::uint64_t transform_max =
      transform_min + in.ue("log2_diff_max_min_luma_transform_block_size");
  if (coding_max > 6 || coding_max < 4 || transform_min >= coding_min ||
      transform_max > std::min<std::uint64_t>(coding_max, 5)) {
    in.fail(Errc::kOutOfRange, "log2_min_luma_coding_block_size_minus3");
    return 0;
  }
  for (const char* depth :
       {"max_transform_hierarchy_depth_inter", "max_transform_hierarchy_depth_intra"})
    if (in.ue(depth) > coding_max - transform_min) in.fail(Errc::kOutOfRange, depth);
  return static_cast<int>(coding_max);
}

/// H.265 7.3.2.2, as far as the reference pictures.
Result<Done> check_sps(Bytes unit, const HevcFormat& expected, HevcReferences& references) {
  const std::vector<std::uint8_t> raw = raw_payload(unit);
  BitReader in(raw);
  in.u(4, "sps_video_parameter_set_id");
  const int sub_layers_minus1 = static_cast<int>(in.u(3, "sps_max_sub_layers_minus1"));
  in.u(1, "sps_temporal_id_nesting_flag");
  if (sub_layers_minus1 > 6) in.fail(Errc::kOutOfRange, "sps_max_sub_layers_minus1");
  if (in.ok()) skip_profile_tier_level(in, sub_layers_minus1);
  const std::uint64_t id = in.ue("sps_seq_parameter_set_id");
  if (id > 15) in.fail(Errc::kOutOfRange, "sps_seq_parameter_set_id");
  const auto size = check_picture_format(in, expected);
  const std::uint64_t count_bits = in.ue("log2_max_pic_order_cnt_lsb_minus4") + 4;
  if (count_bits > 16) in.fail(Errc::kOutOfRange, "log2_max_pic_order_cnt_lsb_minus4");
  const bool each = in.u(1, "sps_sub_layer_ordering_info_present_flag") != 0;
  for (int layer = each ? 0 : sub_layers_minus1; layer <= sub_layers_minus1 && in.ok(); ++layer)
    for (const char* element : {"sps_max_dec_pic_buffering_minus1", "sps_max_num_reorder_pics",
                                "sps_max_latency_increase_plus1"})
      in.ue(element);
  const int block_log2 = in.ok() ? check_blocks(in) : 0;
  // Tools that no encoder of ours uses and whose code in a decoder need not be reachable.
  expect(in, in.u(1, "scaling_list_enabled_flag"), 0, "scaling_list_enabled_flag");
  in.u(1, "amp_enabled_flag");
  in.u(1, "sample_adaptive_offset_enabled_flag");
  expect(in, in.u(1, "pcm_enabled_flag"), 0, "pcm_enabled_flag");
  HevcSequence sequence;
  if (in.ok()) {
    const auto blocks = [&](std::uint64_t n) { return ((n - 1) >> block_log2) + 1; };
    sequence.count_bits = static_cast<int>(count_bits);
    const std::uint64_t count = blocks(size[0]) * blocks(size[1]);
    sequence.address_bits = static_cast<int>(std::bit_width(count - 1));
    read_reference_sets(in, sequence);
  }
  // The place is the NAL unit as a whole: bytes left out of it would have to be counted.
  if (!in.ok()) return Error{in.error().code, in.error().element};
  references.take_sequence(id, std::move(sequence));
  return Done{};
}

/// Counts what has a bound.
struct UnitCounts {
  std::size_t pictures = 0, vps = 0, sps = 0, pps = 0;
  bool within(std::size_t most) const {
    return pictures <= most && vps <= most && sps <= most && pps <= most;
  }
};

Result<Done> check_unit(Bytes unit, const HevcFormat& expected, UnitCounts& counts,
                        HevcReferences& references) {
  const Error damaged{Errc::kOutOfRange, "hevc_nal_unit", 0};
  // forbidden_zero_bit, nuh_layer_id 0, nuh_temporal_id_plus1 not 0; payload.
  if (unit.size() <= kHeaderBytes || unit.size() > kMostUnitBytes || (unit[0] & 0x81) != 0 ||
      unit[1] >> 3 != 0 || (unit[1] & 7) == 0)
    return damaged;
  const int type = unit_type(unit);
  if (is_skipped(type)) return Done{};
  if (type == kSps) SLF_CHECK(check_sps(unit, expected, references));
  counts.vps += type == kVps;
  counts.sps += type == kSps;
  counts.pps += type == kPps;
  if (type < kVps || type > kPps) {
    if (!is_picture(type)) return damaged;
    counts.pictures += unit[kHeaderBytes] >> 7;  // first_slice_segment_in_pic_flag
  }
  if (!counts.within(expected.pictures)) return Error{Errc::kOutOfRange, "hevc_pictures", 0};
  if (type == kPps) return references.take_picture_parameters(raw_payload(unit, kMostHeaderBytes));
  if (!is_picture(type)) return Done{};
  return references.take_slice(type, (unit[1] & 7) - 1, raw_payload(unit, kMostHeaderBytes));
}

}  // namespace

Result<std::vector<Bytes>> split_hevc(Bytes stream, const HevcFormat& expected) {
  if (!is_sound(expected)) return Error{Errc::kOutOfRange, "hevc_format", 0};
  std::vector<Bytes> units;
  UnitCounts counts;
  HevcReferences references;
  std::size_t at = start_code(stream, 0);
  if (at == stream.size()) return Error{Errc::kTruncated, "hevc_start_code", 0};
  if (std::any_of(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(at),
                  [](std::uint8_t byte) { return byte != 0; }))
    return Error{Errc::kOutOfRange, "hevc_start_code", 0};
  while (at < stream.size()) {
    const std::size_t begin = at + 3;
    at = start_code(stream, begin);
    Bytes unit = stream.subspan(begin, at - begin);
    while (!unit.empty() && unit.back() == 0) unit = unit.first(unit.size() - 1);  // B.1
    SLF_CHECK(counted_from(8 * begin, check_unit(unit, expected, counts, references)));
    if (!is_skipped(unit_type(unit))) units.push_back(unit);
  }
  return units;
}

}  // namespace slf
