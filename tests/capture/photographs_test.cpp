// SPDX-License-Identifier: Apache-2.0
// What masks, alpha and what stands beside the pixels of a photograph mean.
#include <gmock/gmock.h>

#include "capture/image_formats.h"
#include "capture/image_reduction.h"
#include "capture/object_mask.h"
#include "capture/upright.h"
#include "capture_formats.h"
#include "slf/jpeg.h"

namespace slf::photographs_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

std::vector<std::uint8_t> flattened(std::vector<std::uint8_t> samples) {
  Image mask{static_cast<int>(samples.size()) / 3, 1, 3, std::move(samples)};
  flatten_mask(mask);
  return mask.data;
}

TEST(Masks, HaveOneLimitWhateverTheirLargestValue) {
  EXPECT_THAT(flattened({0, 1, 1}), ElementsAre(0, 255, 255));
  EXPECT_THAT(flattened({0, 3, 7}), ElementsAre(0, 255, 255));  // labels
  EXPECT_THAT(flattened({0, 254, 255}), ElementsAre(0, 255, 255));
  EXPECT_THAT(flattened({0, 254, 254}), ElementsAre(0, 255, 255));
  EXPECT_THAT(flattened({3, 127, 128}), ElementsAre(0, 0, 255));
  EXPECT_THAT(flattened({0, 0, 0}), Each(0));
}

TEST(Masks, AnAlphaThatIsOpaqueEverywhereIsNone) {
  Image image = photograph(4);
  for (std::size_t i = 3; i < image.data.size(); i += 4) image.data[i] = 255;
  EXPECT_EQ(without_opaque_alpha(image).data, photograph().data);
  image.data[7] = 254;
  EXPECT_EQ(without_opaque_alpha(image).channels, 4);
}

/// Three points near the middle of both photographs; masks of a square of pixels.
Result<Capture, InputError> masked(std::uint8_t inside, std::uint8_t outside) {
  return load_with([&](const fs::path& p) {
    std::string json = kCamerasJson;
    for (const char* name : {"a", "b"})
      json = replaced(json, std::string("\"image\": \"images/") + name + ".png\"",
                      std::string("\"image\": \"images/") + name + ".png\", \"mask\": \"m.png\"");
    write_shared(p, json);
    Image mask{kWidth, kHeight, 3, std::vector<std::uint8_t>(3 * kWidth * kHeight, outside)};
    for (std::size_t y = 0; y < kHeight - 1; ++y)
      for (std::size_t x = 5; x < 15; ++x)
        for (std::size_t c = 0; c < 3; ++c) mask.data[3 * (y * kWidth + x) + c] = inside;
    ASSERT_TRUE(write_png(p / "m.png", mask));
  });
}

TEST(Masks, ThatLeaveNothingOfTheCloudAreNoticed) {
  for (const int inside : {1, 254, 255}) {
    const auto right = masked(static_cast<std::uint8_t>(inside), 0);
    ASSERT_TRUE(right) << right.error().message;
    EXPECT_THAT(right->warnings, IsEmpty());
  }
  for (const int outside : {0, 1, 255}) {
    const auto wrong = masked(0, static_cast<std::uint8_t>(outside));
    ASSERT_TRUE(wrong) << wrong.error().message;
    EXPECT_THAT(wrong->warnings, ElementsAre(HasSubstr("0.0 % of the points")));
  }
}

/// A segment of a JPEG: EXIF with an orientation, as cameras write it.
std::string exif(int orientation, bool big_endian) {
  ByteString tiff;
  tiff.text(big_endian ? "MM" : "II").put(std::uint16_t{42}, big_endian);
  tiff.put(std::uint32_t{8}, big_endian).put(std::uint16_t{2}, big_endian);
  tiff.put(std::uint16_t{0x010F}, big_endian).put(std::uint16_t{2}, big_endian);
  tiff.put(std::uint32_t{4}, big_endian).text("abc").put('\0');
  tiff.put(std::uint16_t{0x0112}, big_endian).put(std::uint16_t{3}, big_endian);
  tiff.put(std::uint32_t{1}, big_endian).put(std::uint16_t(orientation), big_endian);
  return std::string("Exif\0\0", 6) + tiff.put(std::uint16_t{0}).put(std::uint32_t{0}).bytes;
}

std::string segment(char marker, const std::string& data) {
  ByteString out;
  out.put('\xFF').put(marker).put(std::uint16_t(data.size() + 2), true);
  return out.text(data).bytes;
}

std::string jpeg_of(int width, int height, const std::string& segments) {
  const Image image{width, height, 3, std::vector<std::uint8_t>(std::size_t(width * height) * 3)};
  const auto bytes = encode_jpeg(image, 90);
  EXPECT_TRUE(bytes);
  const std::string whole(bytes->begin(), bytes->end());
  return whole.substr(0, 2) + segments + whole.substr(2);
}

/// The set-up with photographs of another form; cameras of 16 x 12, or square.
Result<Capture, InputError> with_photographs(const std::string& file, bool square) {
  return load_with([&](const fs::path& p) {
    std::string json = kCamerasJson;
    for (int i = 0; i < 2 && square; ++i) json = replaced(json, "\"height\": 12", "\"height\": 16");
    write_shared(p, json);
    write_text(p / "images/a.png", file);
    write_text(p / "images/b.png", file);
  });
}

TEST(Photographs, AnOrientationIsNamedWhereItsSizeDoesNotTell) {
  for (const bool big_endian : {false, true}) {
    const std::string turned = segment('\xE1', exif(6, big_endian));
    const auto square = with_photographs(jpeg_of(16, 16, turned), true);
    ASSERT_TRUE(square) << square.error().message;
    EXPECT_THAT(square->warnings, ElementsAre(AllOf(HasSubstr("2 of 2 photographs"),
                                                    HasSubstr("a.png) have an EXIF orient"))));
    // As stored: the calibration is that of the stored pixels.
    const auto stored = with_photographs(jpeg_of(16, 12, turned), false);
    ASSERT_TRUE(stored) << stored.error().message;
    EXPECT_THAT(stored->warnings, IsEmpty());
    EXPECT_THAT(stored->orientation, IsEmpty());
    const auto upright = with_photographs(jpeg_of(16, 16, segment('\xE1', exif(1, false))), true);
    ASSERT_TRUE(upright) << upright.error().message;
    EXPECT_THAT(upright->warnings, IsEmpty());
  }
  EXPECT_THAT(message_of(with_photographs(jpeg_of(12, 16, ""), false)),
              HasSubstr("a.png: image of 12 x 16 pixels, calibrated as 16 x 12"));
}

TEST(Photographs, WhoseSizeDoesNotTellAreTurnedWhereAnotherIs) {
  const auto with_upside_down = [](const std::string& other) {
    return load_with([&](const fs::path& p) {
      write_shared(p);
      write_text(p / "images/a.png", other);
      write_text(p / "images/b.png", jpeg_of(16, 12, segment('\xE1', exif(3, false))));
    });
  };
  const auto turned = with_upside_down(jpeg_of(12, 16, segment('\xE1', exif(6, false))));
  ASSERT_TRUE(turned) << turned.error().message;
  EXPECT_THAT(turned->orientation, ElementsAre(6, 3));
  EXPECT_THAT(turned->warnings, IsEmpty());
  const auto stored = with_upside_down(jpeg_of(16, 12, segment('\xE1', exif(6, false))));
  ASSERT_TRUE(stored) << stored.error().message;
  EXPECT_THAT(stored->orientation, IsEmpty());
  EXPECT_THAT(stored->warnings, ElementsAre(AllOf(HasSubstr("1 of 2 photographs (b.png) has an "),
                                                  HasSubstr("EXIF orientation"))));
}

// The letter F of 3 x 2 pixels' numbers, as each orientation stores it: row by row what is seen.
TEST(Photographs, AreShownAsTheirOrientationSays) {
  const auto shown = [](int orientation) {
    Image stored{3, 2, 3, {}};
    for (std::uint8_t i = 1; i <= 6; ++i) stored.data.insert(stored.data.end(), 3, i);
    const Image image = upright(stored, orientation);
    EXPECT_EQ(image.width, orientation >= 5 ? 2 : 3);
    EXPECT_EQ(image.height, orientation >= 5 ? 3 : 2);
    std::vector<int> pixels;
    for (std::size_t i = 0; i < image.data.size(); i += 3) pixels.push_back(image.data[i]);
    return pixels;
  };
  EXPECT_THAT(shown(1), ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_THAT(shown(2), ElementsAre(3, 2, 1, 6, 5, 4));
  EXPECT_THAT(shown(3), ElementsAre(6, 5, 4, 3, 2, 1));
  EXPECT_THAT(shown(4), ElementsAre(4, 5, 6, 1, 2, 3));
  EXPECT_THAT(shown(5), ElementsAre(1, 4, 2, 5, 3, 6));
  EXPECT_THAT(shown(6), ElementsAre(4, 1, 5, 2, 6, 3));
  EXPECT_THAT(shown(7), ElementsAre(6, 3, 5, 2, 4, 1));
  EXPECT_THAT(shown(8), ElementsAre(3, 6, 2, 5, 1, 4));
}

TEST(Photographs, AreTurnedWhereOnlySoTheyHaveTheirCalibratedSize) {
  Image seen{16, 12, 3, std::vector<std::uint8_t>(16 * 12 * 3, 20)};  // bright at the top left
  for (std::size_t y = 0; y < 4; ++y)
    for (std::size_t x = 0; x < 3 * 8; ++x) seen.data[y * 16 * 3 + x] = 220;
  const Image stored = upright(seen, 8);  // turned to the left; 6 turns it back
  const auto bytes = encode_jpeg(stored, 95);
  ASSERT_TRUE(bytes);
  const std::string whole(bytes->begin(), bytes->end());
  const std::string file = whole.substr(0, 2) + segment('\xE1', exif(6, true)) + whole.substr(2);
  // Files are read when they are needed, so the folder has to stay.
  const TemporaryDirectory directory;
  write_shared(directory.path());
  for (const char* name : {"images/a.png", "images/b.png"}) write_text(directory / name, file);
  auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(capture->warnings, IsEmpty());
  EXPECT_THAT(capture->orientation, ElementsAre(6, 6));
  const auto image = load_image(*capture, 0);
  ASSERT_TRUE(image) << image.error().message;
  ASSERT_EQ(image->width, 16);
  for (std::size_t i = 0; i < seen.data.size(); ++i)
    ASSERT_NEAR(image->data[i], seen.data[i], 24) << i;  // of JPEG, at an edge
  // Smaller ones are those of the upright picture: 5 x 4 blocks of 4 begin at its corner.
  capture->reduction = {2, 2};
  for (Camera& camera : capture->cameras) camera = reduced(camera, 2);
  const auto small = load_image(*capture, 0);
  ASSERT_TRUE(small) << small.error().message;
  EXPECT_EQ(small->data, reduced(*image, 2).data);
}

TEST(Photographs, AColourProfileThatIsNotSrgbIsNamed) {
  const auto profile = [](const std::string& description) {
    return segment('\xE2',
                   std::string("ICC_PROFILE\0\1\1", 14).append(128, '\1').append(description));
  };
  const auto p3 = with_photographs(jpeg_of(16, 12, profile("Display P3")), false);
  ASSERT_TRUE(p3) << p3.error().message;
  EXPECT_THAT(p3->warnings, ElementsAre(AllOf(HasSubstr("2 of 2 photographs"),
                                              HasSubstr("have a colour profile"))));
  for (const auto& srgb : {std::string("sRGB IEC61966-2.1"), std::string("s\0R\0G\0B\0", 8)}) {
    const auto plain = with_photographs(jpeg_of(16, 12, profile(srgb)), false);
    ASSERT_TRUE(plain) << plain.error().message;
    EXPECT_THAT(plain->warnings, IsEmpty());
  }
}

// Fresh buffers of the exact size, so that AddressSanitizer sees a read past the end.
TEST(Photographs, NoByteBesideThePixelsLeadsOutOfThem) {
  const std::string whole = jpeg_of(16, 16, segment('\xE1', exif(6, true)));
  for (std::size_t size = 0; size < std::min<std::size_t>(whole.size(), 80); ++size) {
    const std::vector<std::uint8_t> cut(whole.begin(), whole.begin() + std::ptrdiff_t(size));
    EXPECT_LE(jpeg_header(cut).orientation, 8);
    EXPECT_EQ(png_header(cut).orientation, 1);
  }
  for (std::size_t at = 2; at < 60; ++at)
    for (const int value : {0, 1, 127, 255}) {
      std::vector<std::uint8_t> other(whole.begin(), whole.end());
      other[at] = static_cast<std::uint8_t>(value);
      const int orientation = jpeg_header(other).orientation;
      EXPECT_TRUE(orientation >= 1 && orientation <= 8);
    }
}

}  // namespace
}  // namespace slf::photographs_test
