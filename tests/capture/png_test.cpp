// SPDX-License-Identifier: Apache-2.0
// PNG in, PNG out.
#include <gmock/gmock.h>
#include <sys/resource.h>

#include <iterator>

#include "capture/image_formats.h"
#include "image_files.h"

namespace slf::png_test {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Kind {
  const char* name;
  std::string file;
  int channels;
  std::vector<std::uint8_t> data;  // of 2 x 1 pixels
};
void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
class PngKind : public testing::TestWithParam<Kind> {};

TEST_P(PngKind, BecomesEightBitRgbOrRgba) {
  const auto image = read(GetParam().file);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 2);
  EXPECT_EQ(image->height, 1);
  EXPECT_EQ(image->channels, GetParam().channels);
  EXPECT_EQ(image->data, GetParam().data);
}

TEST_P(PngKind, EveryTruncationIsAnError) {
  const std::string& whole = GetParam().file;
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const std::string cut = whole.substr(0, size);
    const auto image = read(cut);
    ASSERT_FALSE(image) << size << " of " << whole.size() << " bytes";
    EXPECT_EQ(image.error().code, Errc::kInvalidInput);
    EXPECT_THAT(image.error().message, HasSubstr("/image: "));
  }
}
const std::string kPalette = chunk("PLTE", bytes({9, 8, 7, 200, 100, 50}));
INSTANTIATE_TEST_SUITE_P(
    Kinds, PngKind,
    testing::Values(
        Kind{"rgb8", png(2, 1, 8, 2, bytes({0, 1, 2, 3, 4, 5, 6})), 3, {1, 2, 3, 4, 5, 6}},
        // 16 bits are rounded: 0x0180 / 257 = 1.49; 0x0181 / 257 = 1.498; 0x0182 / 257 = 1.502.
        Kind{"rgb16",
             png(2, 1, 16, 2, bytes({0, 1, 0x80, 1, 0x82, 255, 255, 0, 0, 0, 200, 0x7F, 0xFF})),
             3,
             {1, 2, 255, 0, 1, 127}},
        Kind{"grey1", png(2, 1, 1, 0, bytes({0, 0x40})), 3, {0, 0, 0, 255, 255, 255}},
        Kind{"grey8", png(2, 1, 8, 0, bytes({0, 10, 20})), 3, {10, 10, 10, 20, 20, 20}},
        Kind{"grey16", png(2, 1, 16, 0, bytes({0, 10, 10, 20, 20})), 3, {10, 10, 10, 20, 20, 20}},
        Kind{"grey_alpha",
             png(2, 1, 8, 4, bytes({0, 10, 0, 20, 255})),
             4,
             {10, 10, 10, 0, 20, 20, 20, 255}},
        Kind{"rgba8",
             png(2, 1, 8, 6, bytes({0, 1, 2, 3, 0, 4, 5, 6, 128})),
             4,
             {1, 2, 3, 0, 4, 5, 6, 128}},
        Kind{"palette", png(2, 1, 8, 3, bytes({0, 1, 0}), kPalette), 3, {200, 100, 50, 9, 8, 7}},
        Kind{"palette_trns",
             png(2, 1, 8, 3, bytes({0, 1, 0}), kPalette + chunk("tRNS", bytes({0}))),
             4,
             {200, 100, 50, 255, 9, 8, 7, 0}},
        Kind{
            "rgb_trns",
            png(2, 1, 8, 2, bytes({0, 1, 2, 3, 4, 5, 6}), chunk("tRNS", bytes({0, 4, 0, 5, 0, 6}))),
            4,
            {1, 2, 3, 255, 4, 5, 6, 0}}),
    [](const auto& kind) { return kind.param.name; });

TEST(Png, EveryFlippedByteGivesAnImageOrAnError) {
  const std::string whole = png(2, 1, 8, 2, bytes({0, 1, 2, 3, 4, 5, 6}));
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(changed[i] ^ 0x55);
    const auto image = read(changed);
    if (image) continue;
    EXPECT_THAT(image.error().message, HasSubstr("/image: ")) << i;
  }
}

TEST(Png, SizesBeyondTheLimitsAreRefusedBeforeAllocation) {
  const auto rows = bytes({0, 1, 2, 3});
  const auto refused = [](const std::string& file) {
    const auto image = read(file);
    return image ? "accepted" : image.error().message;
  };
  EXPECT_THAT(refused(png(65536, 1, 8, 2, rows)), HasSubstr("damaged PNG"));  // libpng's limit
  EXPECT_THAT(refused(png(65535, 65535, 8, 2, rows)), HasSubstr("larger than accepted"));
  EXPECT_THAT(refused(png(16384, 16384, 8, 2, rows)), HasSubstr("than its bytes can hold"));
  EXPECT_THAT(refused(png(0, 1, 8, 2, rows)), HasSubstr("damaged PNG"));
}

TEST(WritePng, WhatIsWrittenIsReadBack) {
  const TemporaryDirectory directory;
  for (const int channels : {3, 4}) {
    Image image{5, 3, channels, {}};
    for (int i = 0; i < 15 * channels; ++i) image.data.push_back(static_cast<std::uint8_t>(i * 7));
    ASSERT_TRUE(write_png(directory / "a.png", image));
    const auto back = read_image(directory / "a.png");
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_EQ(back->channels, channels);
    EXPECT_EQ(back->data, image.data);
  }
}

TEST(WritePng, FieldsThatDoNotFitTogetherAreRefused) {
  const TemporaryDirectory directory;
  for (const Image& image : {Image{2, 2, 3, std::vector<std::uint8_t>(11)}, Image{0, 2, 3, {}},
                             Image{2, 2, 1, std::vector<std::uint8_t>(4)}}) {
    const auto written = write_png(directory / "a.png", image);
    ASSERT_FALSE(written);
    EXPECT_EQ(written.error().code, Errc::kInvalidArgument);
  }
  EXPECT_EQ(directory.num_entries(), 0u);
}

std::uint64_t most_resident_bytes() {
  rusage usage{};
  ::getrusage(RUSAGE_SELF, &usage);
  return std::uint64_t(usage.ru_maxrss) << 10;
}

TEST(Png, TextBesideThePixelsIsNotUnpacked) {
  const std::string text =
      chunk("zTXt", std::string("Comment\0\0", 9) + deflated(std::string(8 << 20, ' ')));
  std::string texts;
  for (int i = 0; i < 64; ++i) texts += text;
  const std::string file = png(2, 1, 8, 2, bytes({0, 1, 2, 3, 4, 5, 6}), texts);
  const std::uint64_t before = most_resident_bytes();
  const auto image = read(file);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->data, (std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6}));
  EXPECT_LT(most_resident_bytes() - before, 32u << 20);  // 512 MB of text
}

}  // namespace
}  // namespace slf::png_test
