// Video codec adapters: what goes in comes out, and nothing hostile gets through.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <thread>

#include "tests/video_support.h"
#include "video/av1_codec.h"
#include "video/hevc_decoder.h"
#include "video/hevc_encoder.h"
#include "video/hevc_stream.h"

#ifndef SLF_WITH_X265
#define SLF_WITH_X265 0
#endif
#ifndef SLF_WITH_HEVC
#define SLF_WITH_HEVC 0
#endif
#ifndef SLF_WITH_AV1
#define SLF_WITH_AV1 0
#endif

namespace slf {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Waves that move from picture to picture, and some noise: something to predict, and a rest.
Picture test_picture(const HevcFormat& format, std::size_t index) {
  Picture picture = blank_picture(format.width, format.height, format.bits, format.chroma);
  const double half = (1 << format.bits) / 2.0;
  std::uint32_t noise = static_cast<std::uint32_t>(index) * 977u + 1u;
  for (int plane = 0; plane < num_planes(format.chroma); ++plane) {
    const int width = plane_size(format.width, format.chroma, plane);
    auto& samples = picture.planes[static_cast<std::size_t>(plane)];
    for (std::size_t i = 0; i < samples.size(); ++i) {
      const double x = static_cast<double>(i % static_cast<std::size_t>(width)) +
                       2.0 * static_cast<double>(index);
      const double y = static_cast<double>(i / static_cast<std::size_t>(width));
      noise = noise * 1664525u + 1013904223u;
      const double value = half + 0.6 * half * std::sin(0.11 * x + plane) * std::cos(0.07 * y) +
                           half / 64 * (noise >> 24) / 256;
      samples[i] = static_cast<std::uint16_t>(value);
    }
  }
  return picture;
}

Bytes encoded(const HevcFormat& format, const HevcSettings& settings) {
  auto stream = encode_hevc(
      format.pictures, [&](std::size_t i) { return test_picture(format, i); }, settings);
  EXPECT_TRUE(stream) << stream.error().message;
  return stream ? *std::move(stream) : Bytes{};
}

struct Decoded {
  Result<Done> result = Done{};
  std::vector<Picture> pictures;
};

Decoded decoded(const Bytes& stream, const HevcFormat& format) {
  Decoded out;
  out.result = decode_hevc(stream, format, [&](std::size_t i, const Picture& picture) {
    EXPECT_EQ(i, out.pictures.size());
    out.pictures.push_back(picture);
  });
  return out;
}

/// dB, over all samples of all planes and pictures.
double psnr(const std::vector<Picture>& pictures, const HevcFormat& format) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const Picture original = test_picture(format, i);
    for (std::size_t plane = 0; plane < original.planes.size(); ++plane)
      for (std::size_t s = 0; s < original.planes[plane].size(); ++s) {
        const double d = pictures[i].planes[plane][s] - double{1} * original.planes[plane][s];
        sum += d * d;
        count += 1;
      }
  }
  const double peak = (1 << format.bits) - 1;
  return 10 * std::log10(peak * peak * count / sum);
}

struct HevcCase {
  const char* name;
  HevcFormat format;
  HevcMode mode;
};

class HevcRoundTrip : public testing::TestWithParam<HevcCase> {};

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

constexpr auto kIntra = HevcMode::kIntra, kLow = HevcMode::kLowDelay;
constexpr auto k400 = ChromaFormat::k400, k420 = ChromaFormat::k420, k444 = ChromaFormat::k444;
INSTANTIATE_TEST_SUITE_P(
    Formats, HevcRoundTrip,
    testing::Values(HevcCase{"grey_8_intra", {128, 96, 8, k400, 3}, kIntra},
                    HevcCase{"grey_10_intra", {100, 75, 10, k400, 2}, kIntra},
                    HevcCase{"grey_12_intra", {67, 129, 12, k400, 2}, kIntra},
                    HevcCase{"grey_8_low_delay", {99, 101, 8, k400, 9}, kLow},
                    HevcCase{"grey_10_low_delay", {128, 96, 10, k400, 4}, kLow},
                    HevcCase{"grey_12_low_delay", {128, 96, 12, k400, 4}, kLow},
                    HevcCase{"chroma_420", {102, 78, 8, k420, 4}, kLow},
                    HevcCase{"chroma_444", {101, 77, 8, k444, 4}, kLow},
                    HevcCase{"chroma_444_10_intra", {101, 77, 10, k444, 2}, kIntra},
                    HevcCase{"smallest", {16, 16, 8, k400, 3}, kLow},
                    HevcCase{"below_a_tree_unit", {45, 200, 10, k400, 2}, kIntra}),
    [](const auto& test) { return std::string(test.param.name); });

constexpr HevcFormat kSmall{80, 72, 8, k400, 4};

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

TEST(HevcDecoder, BytesThatAreNoStreamAreRefused) {
  const HevcFormat one{16, 16, 8, k400, 1};
  for (const Bytes& bytes :
       {Bytes{}, Bytes{0, 0}, Bytes{0, 0, 1}, Bytes{0, 0, 1, 0x42}, Bytes{7, 0, 0, 1, 0x40, 1, 9},
        Bytes{0, 0, 1, 0x42, 1, 1, 2, 3}, Bytes{0, 0, 1, 0x60, 1, 9}, Bytes{0, 0, 1, 0x40, 9, 9}})
    EXPECT_FALSE(split_hevc(bytes, one)) << bytes.size() << " bytes";
}

class Av1RoundTrip : public testing::TestWithParam<HevcCase> {};

Result<Bytes, InputError> encoded_av1(const VideoFormat& format, const Av1Settings& settings) {
  return encode_av1(
      format.pictures, [&](std::size_t i) { return test_picture(format, i); }, settings);
}

Decoded decoded_av1(const Bytes& stream, const VideoFormat& format) {
  Decoded out;
  out.result = decode_av1(stream, format, [&](std::size_t i, const Picture& picture) {
    EXPECT_EQ(i, out.pictures.size());
    out.pictures.push_back(picture);
  });
  return out;
}

TEST_P(Av1RoundTrip, ACoarserLevelIsSmallerAndWorse) {
  SLF_NEEDS_AV1();
  const auto& [name, format, mode] = GetParam();
  double last_psnr = 1e9;
  std::size_t last_bytes = SIZE_MAX;
  for (const auto& [level, floor] : {std::pair{8, 46.0}, {45, 34.0}}) {
    const auto stream = encoded_av1(
        format, {.cq_level = level, .cpu_used = 6, .intra_only = mode == HevcMode::kIntra});
    ASSERT_TRUE(stream) << stream.error().message;
    const Decoded back = decoded_av1(*stream, format);
    ASSERT_TRUE(back.result) << to_string(back.result.error());
    ASSERT_EQ(back.pictures.size(), format.pictures);
    const double now = psnr(back.pictures, format);
    EXPECT_GT(now, floor) << "level " << level;
    EXPECT_LT(now, last_psnr);
    EXPECT_LT(stream->size(), last_bytes);
    last_psnr = now;
    last_bytes = stream->size();
  }
}

INSTANTIATE_TEST_SUITE_P(Formats, Av1RoundTrip,
                         testing::Values(HevcCase{"grey_8_intra", {67, 50, 8, k400, 3}, kIntra},
                                         HevcCase{"grey_10", {64, 64, 10, k400, 5}, kLow},
                                         HevcCase{"grey_12", {64, 64, 12, k400, 5}, kLow},
                                         HevcCase{"chroma_420", {102, 78, 8, k420, 20}, kLow},
                                         HevcCase{"chroma_444", {51, 77, 8, k444, 4}, kLow}),
                         [](const auto& test) { return std::string(test.param.name); });

TEST(Av1Codec, AnotherFormatIsRefused) {
  SLF_NEEDS_AV1();
  const auto stream = encoded_av1(kSmall, {.cpu_used = 8});
  ASSERT_TRUE(stream) << stream.error().message;
  const auto element = [&](const VideoFormat& expected) -> std::string {
    const Decoded out = decoded_av1(*stream, expected);
    EXPECT_TRUE(out.pictures.empty());
    return out.result ? "" : out.result.error().element;
  };
  EXPECT_EQ(element({81, 72, 8, k400, 4}), "av1_sequence_header");
  EXPECT_EQ(element({80, 70, 8, k400, 4}), "av1_sequence_header");
  EXPECT_EQ(element({80, 72, 10, k400, 4}), "av1_picture");
  EXPECT_EQ(element({80, 72, 8, k444, 4}), "av1_picture");
  EXPECT_EQ(element({80, 72, 8, k400, 3}), "av1_pictures");
  EXPECT_EQ(element({80, 72, 8, k400, 5}), "av1_pictures");
}

TEST(Av1Codec, TruncationIsAnErrorAndDamageGivesAnErrorOrPictures) {
  SLF_NEEDS_AV1();
  const auto stream = encoded_av1(kSmall, {.cq_level = 12, .cpu_used = 8});
  ASSERT_TRUE(stream) << stream.error().message;
  for (std::size_t size = 0; size < stream->size(); size += 97)
    EXPECT_FALSE(
        decoded_av1({stream->begin(), stream->begin() + static_cast<long>(size)}, kSmall).result);
  for (std::size_t at = 0; at < stream->size(); at += at < 60 ? 1 : 13) {
    Bytes damaged = *stream;
    damaged[at] ^= 0x10;
    const Decoded out = decoded_av1(damaged, kSmall);
    EXPECT_FALSE(out.result && out.pictures.size() != kSmall.pictures) << "byte " << at;
    for (const Picture& picture : out.pictures) EXPECT_EQ(picture.planes[0].size(), 80u * 72);
  }
}

TEST(Av1Codec, BytesAreTheSameAgain) {
  SLF_NEEDS_AV1();
  EXPECT_EQ(*encoded_av1(kSmall, {.cpu_used = 8}), *encoded_av1(kSmall, {.cpu_used = 8}));
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
}  // namespace slf
