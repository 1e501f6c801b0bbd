// SPDX-License-Identifier: Apache-2.0
// What damaged streams of frames may do: give an error that names its place, no more.
#include "frames_edit.h"

namespace slf::frames_hazards_test {
namespace {

using namespace test;

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

TEST(Spec_7_13_Hazards, EveryFlippedByteBehindASoundCrcIsAnErrorOrALightField) {
  expect_flips_are_harmless(joined(coded_frames(small_fields(4), small_parameters(), 3)),
                            kSignature.size());
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

TEST(Spec_8_12_Frames, TheEncoderNeedsNoBytesThatItGaveOut) {
  const auto fields = fields_of(Moves::kTurn, 3, 12);
  CodingParameters p = frame_parameters(4, 12);
  p.transform = TransformMode::kFunctions;
  const std::vector<Bytes> expected = coded_frames(fields, p);
  FrameEncoder encoder(p);
  for (std::size_t t = 0; t < 3; ++t) {
    auto bytes = encoder.add(fields[t], 0.5 + static_cast<double>(t) / 30);
    ASSERT_TRUE(bytes) << bytes.error().message;
    EXPECT_TRUE(*bytes == expected[t]) << t;
    std::fill(bytes->begin(), bytes->end(), std::uint8_t{0xAA});
  }
}

}  // namespace
}  // namespace slf::frames_hazards_test
