// SPDX-License-Identifier: Apache-2.0
// Streams of frames, taken apart and changed.
#pragma once

#include <functional>

#include "bitstream/parameter_sets.h"
#include "codec/encoder/assemble.h"
#include "codec/frame_header.h"
#include "frames_support.h"
#include "slf/decoder.h"

namespace slf::test {

struct OwnedUnit {
  UnitType type;
  Bytes payload;
};
/// Units of a frame. An intra frame has a signature, and its first is the sequence.
using Frame = std::vector<OwnedUnit>;

inline std::vector<LightField> small_fields(int frames) {
  std::vector<LightField> fields;
  for (int t = 0; t < frames; ++t) {
    std::vector<Voxel> voxels;
    for (const Voxel& v : sphere_cloud(4)) voxels.push_back({v[0] + t, v[1], v[2]});
    fields.push_back(make_field(sorted_distinct(voxels), 5, 2, 300));
  }
  return fields;
}

inline CodingParameters small_parameters() {
  CodingParameters p;
  p.step.assign(2, {16, 20, 24});
  p.group = {0, 1};
  p.geometry_level_ends = {3, 5};
  p.coefficient_level_ends = {2, 5};
  p.threads = 1;
  return p;
}

/// Two groups of three and two frames.
inline std::vector<Bytes> small_frames() {
  return coded_frames(small_fields(5), small_parameters(), 3);
}

inline DecodeOptions small_limits() {
  DecodeOptions options;
  options.limits = fuzz::small_limits();
  return options;
}

inline Frame split(const Bytes& frame) {
  Frame units;
  std::size_t at = frame[0] == kSignature[0] ? kSignature.size() : 0;
  while (at < frame.size()) {
    const Unit unit = *read_unit(frame, at);
    units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}});
    at += unit.bytes;
  }
  return units;
}

inline std::size_t place_of_frame_unit(const Frame& units) {
  return units[0].type == UnitType::kSequence ? 1 : 0;
}

/// The minor version that a sequence unit needs; 0 of any other, and where it cannot be read.
inline int version_minor(const OwnedUnit& unit) {
  if (unit.type != UnitType::kSequence) return 0;
  const auto set = parse_sequence_parameter_set(unit.payload);
  return set ? set->version_minor() : 0;
}

/// Sound counts, CRCs and frame_bytes.
inline Bytes joined_units(Frame units, const std::function<void(FrameHeader&)>& edit = {}) {
  const std::size_t at = place_of_frame_unit(units);
  for (std::size_t i = 0; i < units.size(); ++i)
    if (units[i].type == UnitType::kEnd) units[i].payload = end_payload(i);
  if (at < units.size() && units[at].type == UnitType::kFrame) {
    std::span<const std::uint8_t> vectors;
    FrameHeader header = *parse_frame_header(units[at].payload, vectors);
    const Bytes rest(vectors.begin(), vectors.end());
    header.frame_bytes = 0;
    for (std::size_t i = at + 1; i < units.size(); ++i)
      header.frame_bytes +=
          static_cast<std::uint32_t>(unit_bytes(units[i].type, units[i].payload.size()));
    if (edit) edit(header);
    for (auto& size : header.motion.lattice_size) --size;
    BitWriter out;
    WriteSyntax write{out};
    frame_unit(write, header);
    units[at].payload = out.take();
    units[at].payload.insert(units[at].payload.end(), rest.begin(), rest.end());
  }
  Bytes bytes;
  if (at == 1) bytes.assign(kSignature.begin(), kSignature.end());
  for (const OwnedUnit& unit : units)
    append_unit(bytes, unit.type, unit.payload, version_minor(unit));
  return bytes;
}

/// All that is asked of any bytes; the error of the first that fails.
inline std::optional<Error> decode_all(const Bytes& stream, const DecodeOptions& options = {}) {
  (void)decode(stream, options);
  (void)read_info(stream, options.limits);
  auto decoder = FrameDecoder::open(stream, options);
  if (!decoder) return decoder.error();
  std::optional<Error> first;
  for (std::size_t t = 0; t < decoder->frames().size(); ++t)
    if (const auto field = decoder->decode(t); !field && !first) first = field.error();
  return first;
}

/// A flipped bit in each byte from `first` on, behind a sound checksum, is an error that names its
/// element, or gives light fields.
inline void expect_flips_are_harmless(const Bytes& whole, std::size_t first) {
  for (std::size_t at = first; at < whole.size(); ++at) {
    Bytes damaged = whole;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 1 << at * 5 % 8);
    damaged = fuzz::with_sound_crcs_of_frames(damaged);
    if (const auto error = decode_all(damaged, small_limits())) {
      EXPECT_STRNE(error->element, "") << at;
    }
  }
}

inline void expect_error(const Bytes& stream, Errc code, const char* element, const char* unit) {
  const auto error = decode_all(stream);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, code) << to_string(*error);
  EXPECT_STREQ(error->element, element);
  EXPECT_STREQ(error->unit, unit);
}

}  // namespace slf::test
