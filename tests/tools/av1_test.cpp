// SPDX-License-Identifier: Apache-2.0
// The adapter of AV1: what goes in comes out, and nothing hostile gets through.
#include "tools/rd/igc/av1_codec.h"

#include "tests/attributes/video_pictures.h"

namespace slf::av1_test {
namespace {

using namespace test;

class Av1RoundTrip : public testing::TestWithParam<VideoCase> {};

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
                         testing::Values(VideoCase{"grey_8_intra", {67, 50, 8, k400, 3}, kIntra},
                                         VideoCase{"grey_10", {64, 64, 10, k400, 5}, kLow},
                                         VideoCase{"grey_12", {64, 64, 12, k400, 5}, kLow},
                                         VideoCase{"chroma_420", {102, 78, 8, k420, 20}, kLow},
                                         VideoCase{"chroma_444", {51, 77, 8, k444, 4}, kLow}),
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

}  // namespace
}  // namespace slf::av1_test
