// What damaged and hostile streams of frames may do: give an error that names its place, no more.
#include <chrono>
#include <functional>

#include "bitstream/parameter_sets.h"
#include "codec/assemble.h"
#include "codec/frame_header.h"
#include "slf/decoder.h"
#include "slf/truncate.h"
#include "tests/frames_support.h"

namespace slf::frames_hazards_test {
namespace {

using namespace test;

struct OwnedUnit {
  UnitType type;
  Bytes payload;
};
using Frame =
    std::vector<OwnedUnit>;  // of an intra frame, which has a signature, the first is its sequence

std::vector<LightField> small_fields(int frames) {
  std::vector<LightField> fields;
  for (int t = 0; t < frames; ++t) {
    std::vector<Voxel> voxels;
    for (const Voxel& v : sphere_cloud(4)) voxels.push_back({v[0] + t, v[1], v[2]});
    fields.push_back(make_field(sorted_distinct(voxels), 5, 2, 300));
  }
  return fields;
}

CodingParameters small_parameters() {
  CodingParameters p;
  p.step.assign(2, {16, 20, 24});
  p.group = {0, 1};
  p.geometry_level_ends = {3, 5};
  p.coefficient_level_ends = {2, 5};
  p.threads = 1;
  return p;
}

/// Two groups of three and two frames.
std::vector<Bytes> small_frames() { return coded_frames(small_fields(5), small_parameters(), 3); }

DecodeOptions small_limits() {
  DecodeOptions options;
  options.limits = fuzz::small_limits();
  return options;
}

Frame split(const Bytes& frame) {
  Frame units;
  std::size_t at = frame[0] == kSignature[0] ? kSignature.size() : 0;
  while (at < frame.size()) {
    const Unit unit = *read_unit(frame, at);
    units.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}});
    at += unit.bytes;
  }
  return units;
}

std::size_t place_of_frame_unit(const Frame& units) {
  return units[0].type == UnitType::kSequence ? 1 : 0;
}

/// Sound counts, CRCs and frame_bytes.
Bytes joined_units(Frame units, const std::function<void(FrameHeader&)>& edit = {}) {
  const std::size_t at = place_of_frame_unit(units);
  for (std::size_t i = 0; i < units.size(); ++i)
    if (units[i].type == UnitType::kEnd) units[i].payload = end_payload(i);
  if (at < units.size() && units[at].type == UnitType::kFrame) {
    std::span<const std::uint8_t> vectors;
    FrameHeader header = *parse_frame_header(units[at].payload, vectors);
    const Bytes rest(vectors.begin(), vectors.end());
    header.frame_bytes = 0;
    for (std::size_t i = at + 1; i < units.size(); ++i)
      header.frame_bytes += static_cast<std::uint32_t>(unit_bytes(units[i].payload.size()));
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
  for (const OwnedUnit& unit : units) append_unit(bytes, unit.type, unit.payload);
  return bytes;
}

/// All that is asked of any bytes; the error of the first that fails.
std::optional<Error> decode_all(const Bytes& stream, const DecodeOptions& options = {}) {
  (void)decode(stream, options);
  (void)read_info(stream, options.limits);
  auto decoder = FrameDecoder::open(stream, options);
  if (!decoder) return decoder.error();
  std::optional<Error> first;
  for (std::size_t t = 0; t < decoder->frames().size(); ++t)
    if (const auto field = decoder->decode(t); !field && !first) first = field.error();
  return first;
}

void expect_error(const Bytes& stream, Errc code, const char* element, const char* unit) {
  const auto error = decode_all(stream);
  ASSERT_TRUE(error);
  EXPECT_EQ(error->code, code) << to_string(*error);
  EXPECT_STREQ(error->element, element);
  EXPECT_STREQ(error->unit, unit);
}

TEST(Spec_7_13_Hazards, HelpersGiveBackWhatWasCoded) {
  for (const Bytes& frame : small_frames()) EXPECT_EQ(joined_units(split(frame)), frame);
}

TEST(Spec_7_13_Hazards, EveryTruncationIsReportedOrIsAPartialLightField) {
  const auto frames = small_frames();
  const Bytes whole = joined(frames);
  ASSERT_FALSE(decode_all(whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    auto decoder = FrameDecoder::open(cut);
    if (!decoder) {
      EXPECT_EQ(decoder.error().code, size == 0 ? Errc::kNotSlf : Errc::kTruncated) << size;
      continue;
    }
    const std::size_t last = decoder->frames().size() - 1;
    std::size_t begin = 0;
    for (std::size_t t = 0; t < last; ++t) begin += frames[t].size();
    EXPECT_LE(begin, size);
    const auto field = decoder->decode(last);
    const bool is_whole = begin + frames[last].size() <= size;
    if (field) {
      EXPECT_EQ(field->partial, !is_whole) << size;
    } else {
      EXPECT_EQ(field.error().code, Errc::kTruncated) << size << to_string(field.error());
      EXPECT_FALSE(is_whole) << size;
    }
  }
}

TEST(Spec_7_13_Hazards, EveryFlippedByteIsNoticed) {
  const Bytes whole = joined(small_frames());
  for (std::size_t at = 0; at < whole.size(); ++at) {
    Bytes damaged = whole;
    damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ 0x81);
    if (decode_all(damaged, small_limits())) continue;
    const auto frames = list_frames(damaged);  // a length that leads beyond the end
    ASSERT_TRUE(frames) << at;
    ASSERT_LT(frames->size(), 5u) << at;
    EXPECT_LT(frames->back().offset + frames->back().bytes, damaged.size()) << at;
  }
}

/// The CRCs of the units of every frame, however it says where the next is.
Bytes with_sound_crcs(const std::vector<Bytes>& frames, std::size_t frame, std::size_t at,
                      int bit) {
  std::vector<Bytes> damaged = frames;
  Bytes& bytes = damaged[frame];
  bytes[at] = static_cast<std::uint8_t>(bytes[at] ^ 1 << bit);
  if (bytes[0] == kSignature[0]) {
    bytes = fuzz::with_sound_crcs(bytes);
  } else {
    Bytes shifted(kSignature.begin(), kSignature.end());
    shifted.insert(shifted.end(), bytes.begin(), bytes.end());
    shifted = fuzz::with_sound_crcs(shifted);
    bytes.assign(shifted.begin() + kSignature.size(), shifted.end());
  }
  return joined(damaged);
}

TEST(Spec_7_13_Hazards, EveryFlippedByteBehindASoundCrcIsAnErrorOrALightField) {
  const auto frames = coded_frames(small_fields(3), small_parameters(), 3);
  for (std::size_t frame = 0; frame < frames.size(); ++frame)
    for (std::size_t at = frame == 0 ? kSignature.size() : 0; at < frames[frame].size(); ++at) {
      const int bit = static_cast<int>((at * 5 + frame) % 8);
      for (const int b : {bit, (bit + 3) % 8}) {
        const auto error = decode_all(with_sound_crcs(frames, frame, at, b), small_limits());
        if (error) {
          EXPECT_STRNE(error->element, "") << frame << ' ' << at;
        }
      }
    }
}

TEST(Spec_7_13_Order, FramesOutOfItTwiceOrMissingAreRefused) {
  const auto f = small_frames();
  expect_error(joined({f[0], f[2], f[1]}), Errc::kOutOfRange, "frame_number", "frame");
  expect_error(joined({f[0], f[1], f[1]}), Errc::kOutOfRange, "frame_number", "frame");
  expect_error(joined({f[0], f[0]}), Errc::kOutOfRange, "frame_number", "frame");
  expect_error(joined({f[0], f[2], f[3], f[4]}), Errc::kOutOfRange, "frame_number", "frame");
  expect_error(joined({f[3], f[4], f[0]}), Errc::kOutOfRange, "frame_number", "frame");
  EXPECT_FALSE(decode_all(joined({f[3], f[4]})));  // a stream may begin with any number
  expect_error(f[1], Errc::kNotSlf, "signature", "");
}

TEST(Spec_7_13_Order, TimesAscend) {
  const auto f = small_frames();
  const Bytes late = joined_units(split(f[1]), [](FrameHeader& h) { h.frame_time = 0.5; });
  expect_error(joined({f[0], late}), Errc::kOutOfRange, "frame_time", "frame");
}

TEST(Spec_7_13_Order, PredictedFirstIsRefused) {
  const auto f = small_frames();
  const auto predict = [](FrameHeader& h) { h.frame_predicted_flag = 1; };
  const auto intra = [](FrameHeader& h) { h.frame_predicted_flag = 0; };
  expect_error(joined_units(split(f[0]), predict), Errc::kOutOfRange, "frame_predicted_flag",
               "frame");
  const Bytes second = joined_units(split(f[1]), intra);
  expect_error(joined({f[0], second}), Errc::kOutOfRange, "frame_predicted_flag", "frame");
}

TEST(Spec_8_12_Hazards, DamageEndsWithItsGroup) {
  auto f = small_frames();
  f[1][f[1].size() / 2] ^= 1;
  const Bytes stream = joined(f);
  FrameDecoder decoder = opened(stream);
  ASSERT_EQ(decoder.frames().size(), 5u);
  for (const std::size_t t : {0u, 3u, 4u, 0u}) EXPECT_TRUE(decoder.decode(t)) << t;
  for (const std::size_t t : {1u, 2u, 2u, 1u}) {
    const auto field = decoder.decode(t);
    ASSERT_FALSE(field);
    EXPECT_EQ(field.error().code, Errc::kChecksum);
    EXPECT_GE(field.error().bit_offset, 8 * f[0].size());
    EXPECT_LT(field.error().bit_offset, 8 * (f[0].size() + f[1].size()));
  }
  EXPECT_TRUE(decoder.decode(4));
}

/// An intra frame without its units behind some, and the next.
void expect_lacking(std::size_t keep, bool decodes) {
  const auto f = small_frames();
  Frame units = split(f[0]);
  units.resize(keep);
  const Bytes stream = joined({joined_units(units), f[1]});
  FrameDecoder decoder = opened(stream);
  ASSERT_EQ(decoder.frames().size(), 2u);
  const auto first = decoder.decode(0);
  ASSERT_TRUE(first) << to_string(first.error());
  EXPECT_TRUE(first->partial);
  const auto second = decoder.decode(1);
  ASSERT_EQ(static_cast<bool>(second), decodes) << keep;
  if (!decodes) {
    EXPECT_EQ(second.error().code, Errc::kOutOfRange);
    EXPECT_STREQ(second.error().element, "frame_predicted_flag");
  }
}

TEST(Spec_8_12_5_Hazards, ReferencesThatLackAUnitAreRefused) {
  const std::size_t units = split(small_frames()[0]).size();
  for (std::size_t keep = 2; keep + 2 < units; ++keep) expect_lacking(keep, false);
}

TEST(Spec_8_12_5_Hazards, ReferencesMayLackDigestAndEnd) {
  const std::size_t units = split(small_frames()[0]).size();
  for (const std::size_t fewer : {1u, 2u}) expect_lacking(units - fewer, true);
}

TEST(Spec_7_13_Length, MoreOrLessThanThereIsIsRefused) {
  const auto f = small_frames();
  for (const std::size_t t : {0u, 1u}) {
    auto frames = f;
    const auto change = [&](std::uint32_t by) {
      frames[t] = joined_units(split(f[t]), [&](FrameHeader& h) { h.frame_bytes += by; });
      return joined(frames);
    };
    for (const std::uint32_t by : {1u, ~0u, 7u, ~0u - 6u, 40u, 1u << 20, 1u << 30})
      EXPECT_TRUE(decode_all(change(by))) << t << ' ' << by;
  }
  for (const std::size_t t : {0u, 1u}) {  // of the last, which nothing follows
    const Bytes last = joined_units(split(f[t]), [&](FrameHeader& h) { h.frame_bytes += 9; });
    expect_error(t == 0 ? last : joined({f[0], last}), Errc::kOutOfRange, "frame_bytes", "frame");
  }
  const auto field = decode(joined_units(split(f[0]), [](FrameHeader& h) { ++h.frame_bytes; }));
  ASSERT_FALSE(field);
  EXPECT_STREQ(field.error().element, "frame_bytes");
}

TEST(Spec_7_13_Units, ThatPredictedFramesDoNotHaveAreRefused) {
  const auto f = small_frames();
  for (const UnitType type : {UnitType::kSequence, UnitType::kTransform, UnitType::kIndex,
                              UnitType::kMetadata, UnitType::kFrame})
    for (const std::size_t at : {1u, 2u, 4u}) {
      Frame units = split(f[1]);
      units.insert(units.begin() + static_cast<std::ptrdiff_t>(at),
                   {type, type == UnitType::kFrame ? units[0].payload : split(f[0])[0].payload});
      expect_error(joined({f[0], joined_units(units)}), Errc::kOutOfRange, "unit_type",
                   unit_name(type));
    }
}

TEST(Spec_7_13_Units, FillersAndUnknownOnesStandInPredictedFrames) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  for (const UnitType type : {UnitType::kFiller, static_cast<UnitType>(99)})
    units.insert(units.begin() + 2, {type, {1, 2, 3}});
  EXPECT_FALSE(decode_all(joined({f[0], joined_units(units), f[2]})));
}

TEST(Spec_7_13_Units, UnitsBehindTheEndOfAPredictedFrameAreRefused) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  units.push_back({UnitType::kFiller, {}});
  EXPECT_TRUE(decode_all(joined({f[0], joined_units(units)})));
}

TEST(Spec_7_1_Order, FrameUnitIsTheSecondOrThereIsNone) {
  const Bytes still = *pack(small_fields(1)[0], [] {
    CodingParameters p = small_parameters();
    p.index = false;
    p.base_levels = 0;
    return p;
  }());
  const Frame units = split(still);
  const OwnedUnit frame = split(small_frames()[0])[1];
  for (std::size_t at = 2; at < units.size(); ++at) {
    Frame other = units;
    other.insert(other.begin() + static_cast<std::ptrdiff_t>(at), frame);
    expect_error(joined_units(other), Errc::kOutOfRange, "unit_type", "frame");
    EXPECT_FALSE(decode(joined_units(other)));
    EXPECT_FALSE(read_info(joined_units(other)));
  }
  Frame first = units;
  first.insert(first.begin(), frame);
  Bytes bytes(kSignature.begin(), kSignature.end());
  for (const OwnedUnit& unit : first) append_unit(bytes, unit.type, unit.payload);
  EXPECT_TRUE(decode_all(bytes));
  Frame two = units;
  two.insert(two.begin() + 1, 2, frame);
  expect_error(joined_units(two), Errc::kOutOfRange, "unit_type", "frame");
}

TEST(Spec_7_13_Hazards, DamagedFrameUnitIsAnErrorOfOneLightFieldToo) {
  const Bytes stream = small_frames()[0];
  Frame units = split(stream);
  units[1].payload.push_back(7);
  Bytes bytes(kSignature.begin(), kSignature.end());
  for (const OwnedUnit& unit : units) append_unit(bytes, unit.type, unit.payload);
  for (const auto& error : {decode(bytes).error(), read_info(bytes).error()}) {
    EXPECT_STREQ(error.unit, "frame");
    EXPECT_STREQ(error.element, "frame_vectors");
  }
}

TEST(Spec_7_13_Hazards, SequencesThatFramesDoNotHaveAreRefused) {
  const auto f = small_frames();
  CodingParameters p = small_parameters();
  p.index = false;
  p.base_levels = 2;
  const auto moving = [&](const CodingParameters& parameters) {
    Frame units = split(*pack(small_fields(1)[0], parameters));
    units.insert(units.begin() + 1, split(f[0])[1]);
    return joined_units(units);
  };
  expect_error(moving(p), Errc::kOutOfRange, "sps_base_levels", "sequence");
  p.base_levels = 0;
  EXPECT_FALSE(decode_all(moving(p)));
  p.quality_layers = 2;
  expect_error(moving(p), Errc::kOutOfRange, "sps_coefficient_coder", "sequence");
  p.quality_layers = 1;
  p.coefficients = CoefficientCoder::kIndependent;
  expect_error(moving(p), Errc::kOutOfRange, "sps_coefficient_coder", "sequence");
}

/// A second frame with this motion, as it is coded: of other points than were moved so.
Bytes with_motion(const std::function<void(FrameHeader&)>& edit, const Bytes& vectors = {}) {
  const auto f = small_frames();
  Frame units = split(f[1]);
  std::span<const std::uint8_t> ignored;
  FrameHeader header = *parse_frame_header(units[0].payload, ignored);
  header.frame_motion_flag = 1;
  header.frame_lattice_flag = 0;
  header.motion = {};
  edit(header);
  BitWriter out;
  WriteSyntax write{out};
  frame_unit(write, header);
  units[0].payload = out.take();
  units[0].payload.insert(units[0].payload.end(), vectors.begin(), vectors.end());
  Bytes stream = f[0];
  for (const OwnedUnit& unit : units) append_unit(stream, unit.type, unit.payload);
  return stream;
}

TEST(Spec_8_12_1_Hazards, MotionOutOfTheGridDecodes) {
  auto fields = small_fields(2);
  const auto frames = coded_frames(fields, small_parameters());
  for (const std::int32_t shift : {1 << 19, -(1 << 19), Motion::kMostShift, -Motion::kMostShift}) {
    const Bytes stream = with_motion([&](FrameHeader& h) {
      h.motion.shift = {shift, -shift, shift};
      h.motion.matrix[1][2] = shift < 0 ? -Motion::kMostEntry : Motion::kMostEntry;
    });
    const auto error = decode_all(stream, small_limits());  // of what was coded with another
    if (error) {
      EXPECT_STRNE(error->element, "");
    }
  }
}

/// size: of the lattice, minus one
Bytes with_lattice(const std::array<std::int32_t, 3>& size, const Bytes& vectors, int log2 = 3) {
  return with_motion(
      [&](FrameHeader& h) {
        h.frame_lattice_flag = 1;
        h.motion.lattice_log2 = log2;
        h.motion.lattice_size = size;
      },
      vectors);
}

TEST(Spec_7_13_Lattice, OfMoreThanItsMostPointsIsRefused) {
  expect_error(with_lattice({1 << 18, 0, 0}, {}), Errc::kOutOfRange, "frame_lattice_size_minus1",
               "frame");
  expect_error(with_lattice({63, 63, 64}, {}), Errc::kOutOfRange, "frame_lattice_size_minus1",
               "frame");
}

TEST(Spec_7_13_Lattice, OfMostPointsAndFewBytesIsSoonDone) {
  const auto begin = std::chrono::steady_clock::now();
  for (const int log2 : {3, 8})
    for (const Bytes& vectors : {Bytes{}, Bytes{1, 2, 3, 4, 5}, Bytes(12, 0xFF), Bytes(12, 0)})
      (void)decode_all(with_lattice({63, 63, 63}, vectors, log2), small_limits());
  (void)decode_all(with_lattice({(1 << 18) - 1, 0, 0}, Bytes(5, 0x5A)), small_limits());
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

TEST(Spec_7_13_Lattice, CodewordThatGoesOnIsRefused) {
  expect_error(with_lattice({0, 0, 0}, Bytes(40, 0x55)), Errc::kOutOfRange, "frame_vectors",
               "frame");
}

TEST(Spec_7_13_Hazards, WhatTakesOneLightFieldSaysSo) {
  const auto frames = small_frames();
  for (const Bytes& stream : {frames[0], joined(frames)}) {
    const auto cut = truncate(stream, {});
    ASSERT_FALSE(cut);
    EXPECT_EQ(cut.error().code, Errc::kUnsupported);
    EXPECT_STREQ(cut.error().element, kOneLightField);
  }
}

TEST(Spec_9_Frames, AreHeldToLimitsWithWhatIsKept) {
  const Bytes stream = joined(small_frames());
  DecodeOptions options;
  for (const auto& change : std::vector<std::function<void(DecodeLimits&)>>{
           [](DecodeLimits& l) { l.max_points = 10; },
           [](DecodeLimits& l) { l.max_memory = 1 << 20; },
           [](DecodeLimits& l) { l.max_work = 1000; }}) {
    options.limits = {};
    change(options.limits);
    const auto error = decode_all(stream, options);
    ASSERT_TRUE(error);
    EXPECT_EQ(error->code, Errc::kLimitExceeded);
  }
  options.limits.max_stream_bytes = stream.size() - 1;
  EXPECT_EQ(FrameDecoder::open(stream, options).error().code, Errc::kLimitExceeded);
  options = {};
  options.max_bytes = 100;
  EXPECT_EQ(FrameDecoder::open(stream, options).error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace slf::frames_hazards_test
