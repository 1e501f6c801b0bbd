// SPDX-License-Identifier: Apache-2.0
// Video codec adapters: what goes in comes out, and nothing hostile gets through.
#include <thread>

#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "attributes/video/encoder/hevc_encoder.h"
#include "attributes/video/hevc_decoder.h"
#include "attributes/video/hevc_stream.h"
#include "tools/rd/igc/av1_codec.h"
#include "video_pictures.h"

#ifndef SLF_WITH_X265
#define SLF_WITH_X265 0
#endif
#ifndef SLF_WITH_HEVC
#define SLF_WITH_HEVC 0
#endif
#ifndef SLF_WITH_AV1
#define SLF_WITH_AV1 0
#endif

namespace slf::video_test {
namespace {

using namespace test;

Bytes encoded(const HevcFormat& format, const HevcSettings& settings) {
  auto stream = encode_hevc(
      format.pictures, [&](std::size_t i) { return test_picture(format, i); }, settings);
  EXPECT_TRUE(stream) << stream.error().message;
  return stream ? *std::move(stream) : Bytes{};
}

Decoded decoded(const Bytes& stream, const HevcFormat& format) {
  Decoded out;
  out.result = decode_hevc(stream, format, [&](std::size_t i, const Picture& picture) {
    EXPECT_EQ(i, out.pictures.size());
    out.pictures.push_back(picture);
  });
  return out;
}

/// What new memory holds from now on, where the C library can be told so; 0: as it comes.
void fill_memory([[maybe_unused]] int value) {
#ifdef M_PERTURB
  mallopt(M_PERTURB, value);
#endif
}

class HevcRoundTrip : public testing::TestWithParam<VideoCase> {};

TEST_P(HevcRoundTrip, LosslessGivesBackTheSamples) {
  SLF_NEEDS_HEVC();
  const auto& [name, format, mode] = GetParam();
  const Decoded back =
      decoded(encoded(format, {.mode = mode, .preset = "fast", .lossless = true}), format);
  ASSERT_TRUE(back.result) << to_string(back.result.error());
  ASSERT_EQ(back.pictures.size(), format.pictures);
  for (std::size_t i = 0; i < format.pictures; ++i)
    EXPECT_EQ(back.pictures[i].planes, test_picture(format, i).planes) << "picture " << i;
}

TEST_P(HevcRoundTrip, ACoarserQpIsSmallerAndWorse) {
  SLF_NEEDS_HEVC();
  const auto& [name, format, mode] = GetParam();
  double last_psnr = 1e9;
  std::size_t last_bytes = SIZE_MAX;
  for (const auto& [qp, floor] : {std::pair{10, 46.0}, {30, 34.0}}) {
    const Bytes stream = encoded(format, {.qp = qp, .mode = mode, .preset = "fast"});
    const Decoded back = decoded(stream, format);
    ASSERT_TRUE(back.result) << to_string(back.result.error());
    ASSERT_EQ(back.pictures.size(), format.pictures);
    const double now = psnr(back.pictures, format);
    EXPECT_GT(now, floor) << "qp " << qp;
    EXPECT_LT(now, last_psnr);
    EXPECT_LT(stream.size(), last_bytes);
    last_psnr = now;
    last_bytes = stream.size();
  }
}

INSTANTIATE_TEST_SUITE_P(
    Formats, HevcRoundTrip,
    testing::Values(VideoCase{"grey_8_intra", {128, 96, 8, k400, 3}, kIntra},
                    VideoCase{"grey_10_intra", {100, 75, 10, k400, 2}, kIntra},
                    VideoCase{"grey_12_intra", {67, 129, 12, k400, 2}, kIntra},
                    VideoCase{"grey_8_low_delay", {99, 101, 8, k400, 9}, kLow},
                    VideoCase{"grey_10_low_delay", {128, 96, 10, k400, 4}, kLow},
                    VideoCase{"grey_12_low_delay", {128, 96, 12, k400, 4}, kLow},
                    VideoCase{"chroma_420", {102, 78, 8, k420, 4}, kLow},
                    VideoCase{"chroma_444", {101, 77, 8, k444, 4}, kLow},
                    VideoCase{"chroma_444_10_intra", {101, 77, 10, k444, 2}, kIntra},
                    VideoCase{"smallest", {16, 16, 8, k400, 3}, kLow},
                    VideoCase{"below_a_tree_unit", {45, 200, 10, k400, 2}, kIntra}),
    [](const auto& test) { return std::string(test.param.name); });

TEST(HevcEncoder, BytesAreTheSameWhateverElseRuns) {
  SLF_NEEDS_HEVC();
  std::vector<Bytes> streams(3);
  {
    std::vector<std::jthread> threads;
    for (Bytes& stream : streams)
      threads.emplace_back(
          [&stream] { stream = encoded(kSmall, {.qp = 20, .preset = "superfast"}); });
  }
  const Bytes alone = encoded(kSmall, {.qp = 20, .preset = "superfast"});
  for (const Bytes& stream : streams) EXPECT_EQ(stream, alone);
}

TEST(HevcEncoder, WhatItCannotCodeIsRefused) {
  SLF_NEEDS_HEVC();
  const auto error = [](HevcFormat format, const HevcSettings& settings) {
    const auto source = [&](std::size_t i) { return test_picture(format, i); };
    const auto stream = encode_hevc(format.pictures, source, settings);
    return stream ? std::string() : stream.error().message;
  };
  EXPECT_EQ(error(kSmall, {.qp = 52}), "HEVC encoding: qp: 0 to 51");
  EXPECT_EQ(error(kSmall, {.preset = "fastest"}), "HEVC encoding: no preset is named fastest");
  EXPECT_EQ(error({80, 72, 8, k400, 0}, {}), "HEVC encoding: no pictures");
  EXPECT_NE(error({15, 72, 8, k400, 1}, {}), "");
  EXPECT_NE(error({81, 72, 8, k420, 1}, {}), "");
  EXPECT_NE(error({80, 72, 9, k400, 1}, {}), "");
  const auto growing = [](std::size_t i) {
    return test_picture({80 + static_cast<int>(i), 72, 8, k400, 1}, i);
  };
  EXPECT_FALSE(encode_hevc(2, growing, {}));
}

TEST(HevcDecoder, AStreamOfAnotherFormatIsRefusedBeforeItIsDecoded) {
  SLF_NEEDS_HEVC();
  const Bytes stream = encoded(kSmall, {});
  const auto element = [&](const HevcFormat& expected) -> std::string {
    const Decoded out = decoded(stream, expected);
    EXPECT_TRUE(out.pictures.empty());
    return out.result ? "" : out.result.error().element;
  };
  EXPECT_EQ(element({81, 72, 8, k400, 4}), "pic_width_in_luma_samples");
  EXPECT_EQ(element({16, 72, 8, k400, 4}), "pic_width_in_luma_samples");
  EXPECT_EQ(element({80, 71, 8, k400, 4}), "pic_height_in_luma_samples");
  EXPECT_EQ(element({80, 72, 10, k400, 4}), "bit_depth_luma_minus8");
  EXPECT_EQ(element({80, 72, 8, k444, 4}), "chroma_format_idc");
  EXPECT_EQ(element({80, 72, 8, k400, 3}), "hevc_pictures");
  EXPECT_EQ(element({80, 72, 8, k400, 0}), "hevc_format");
  EXPECT_EQ(element({8193, 72, 8, k400, 4}), "hevc_format");
}

TEST(HevcDecoder, FewerPicturesThanPromisedAreAnError) {
  SLF_NEEDS_HEVC();
  HevcFormat more = kSmall;
  more.pictures = 5;
  const Decoded out = decoded(encoded(kSmall, {}), more);
  ASSERT_FALSE(out.result);
  EXPECT_EQ(out.result.error().code, Errc::kTruncated);
}

TEST(HevcDecoder, TruncationIsAnErrorUnlessTheLastPictureHasBegun) {
  SLF_NEEDS_HEVC();
  const Bytes stream = encoded(kSmall, {.qp = 12});
  const auto units = split_hevc(stream, kSmall);
  ASSERT_TRUE(units);
  const auto last = static_cast<std::size_t>(units->back().data() - stream.data());
  ASSERT_GT(last, 500u);
  for (std::size_t size = 0; size < stream.size(); size += 97) {
    const Bytes cut(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(size));
    const Decoded out = decoded(cut, kSmall);
    EXPECT_FALSE(size <= last && out.result) << size << " of " << stream.size() << " bytes";
    EXPECT_LE(out.pictures.size(), kSmall.pictures);
  }
}

TEST(HevcDecoder, DamageGivesAnErrorOrPicturesOfTheExpectedFormat) {
  SLF_NEEDS_HEVC();
  const Bytes stream = encoded(kSmall, {.qp = 12});
  std::size_t refused = 0, tried = 0;
  for (std::size_t at = 0; at < stream.size(); at += at < 120 ? 1 : 13) {
    for (const int flip : {0x01, 0x80, 0xFF}) {
      Bytes damaged = stream;
      damaged[at] = static_cast<std::uint8_t>(damaged[at] ^ flip);
      const Decoded out = decoded(damaged, kSmall);
      ++tried;
      refused += !out.result;
      EXPECT_FALSE(out.result && out.pictures.size() != kSmall.pictures) << "byte " << at;
      for (const Picture& picture : out.pictures) EXPECT_EQ(picture.planes[0].size(), 80u * 72);
    }
  }
  EXPECT_GT(2 * refused, tried);
}

/// Where the units of a stream begin, behind their start codes.
std::vector<std::size_t> beginnings(const Bytes& stream, const HevcFormat& format) {
  std::vector<std::size_t> begin;
  const auto units = split_hevc(stream, format);
  if (units)
    for (const auto& unit : *units)
      begin.push_back(static_cast<std::size_t>(unit.data() - stream.data()));
  return begin;
}

TEST(HevcDecoder, AReferenceToAPictureThatIsNotThereIsRefusedBeforeItIsDecoded) {
  SLF_NEEDS_HEVC();
  const Bytes stream = encoded(kSmall, {});
  const auto begin = beginnings(stream, kSmall);  // VPS, SPS, PPS, four pictures
  ASSERT_EQ(begin.size(), 7u);
  Bytes cut = stream;
  const auto at = [&](std::size_t unit) {
    return cut.begin() + static_cast<std::ptrdiff_t>(begin[unit]) - 3;
  };
  cut.erase(at(4), at(5));
  const Decoded out = decoded(cut, kSmall);
  ASSERT_FALSE(out.result);
  EXPECT_STREQ(out.result.error().element, "short_term_ref_pic_set");
  EXPECT_EQ(out.result.error().bit_offset / 8, begin[4]);  // where the third picture is now
  EXPECT_TRUE(out.pictures.empty());
}

TEST(HevcDecoder, DamageGivesTheSameSamplesWhateverTheMemoryHeld) {
  SLF_NEEDS_HEVC();
  const HevcFormat format{96, 80, 8, k400, 6};
  const Bytes stream = encoded(format, {.qp = 30, .preset = "medium"});
  const auto begin = beginnings(stream, format);
  ASSERT_EQ(begin.size(), 9u);
  std::size_t accepted = 0;
  for (std::size_t unit = 3; unit < begin.size(); ++unit)
    for (std::size_t bit = 8 * 3; bit < 8 * 7; ++bit) {  // of slice headers
      Bytes damaged = stream;
      auto& byte = damaged[begin[unit] + bit / 8];
      byte = static_cast<std::uint8_t>(byte ^ 1 << bit % 8);
      fill_memory(0x55);
      const Decoded once = decoded(damaged, format);
      fill_memory(0xAA);
      const Decoded again = decoded(damaged, format);
      fill_memory(0);
      ASSERT_EQ(bool{once.result}, bool{again.result}) << "unit " << unit << " bit " << bit;
      if (!once.result) continue;
      ++accepted;
      for (std::size_t i = 0; i < once.pictures.size(); ++i)
        ASSERT_EQ(once.pictures[i].planes, again.pictures[i].planes) << unit << " bit " << bit;
    }
  EXPECT_GT(accepted, 10u);
}

TEST(HevcDecoder, BytesThatAreNoStreamAreRefused) {
  const HevcFormat one{16, 16, 8, k400, 1};
  for (const Bytes& bytes :
       {Bytes{}, Bytes{0, 0}, Bytes{0, 0, 1}, Bytes{0, 0, 1, 0x42}, Bytes{7, 0, 0, 1, 0x40, 1, 9},
        Bytes{0, 0, 1, 0x42, 1, 1, 2, 3}, Bytes{0, 0, 1, 0x60, 1, 9}, Bytes{0, 0, 1, 0x40, 9, 9}})
    EXPECT_FALSE(split_hevc(bytes, one)) << bytes.size() << " bytes";
}

TEST(Adapters, WithoutALibraryTheySaySo) {
  const auto source = [](std::size_t i) { return test_picture(kSmall, i); };
  const auto sink = [](std::size_t, const Picture&) {};
#if !SLF_WITH_X265
  EXPECT_EQ(encode_hevc(1, source, {}).error().code, Errc::kUnsupported);
#endif
#if !SLF_WITH_HEVC
  EXPECT_EQ(decode_hevc({}, kSmall, sink).error().code, Errc::kUnsupported);
#endif
#if !SLF_WITH_AV1
  EXPECT_EQ(encode_av1(1, source, {}).error().code, Errc::kUnsupported);
  EXPECT_EQ(decode_av1({}, kSmall, sink).error().code, Errc::kUnsupported);
#endif
  if (SLF_WITH_X265 + SLF_WITH_HEVC + SLF_WITH_AV1 == 3)
    GTEST_SKIP() << "this build has x265, libde265 and libaom";
  static_cast<void>(source);
  static_cast<void>(sink);
}

}  // namespace
}  // namespace slf::video_test
