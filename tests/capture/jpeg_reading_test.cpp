// SPDX-License-Identifier: Apache-2.0
// JPEG in, and sizes out of headers alone.
#include <gmock/gmock.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
// jpeglib.h needs stdio.
#include <jpeglib.h>

#include "capture/image_formats.h"
#include "image_files.h"

namespace slf::jpeg_reading_test {
namespace {

using namespace test;
using ::testing::HasSubstr;

// Made with Pillow: left half (200, 50, 50), right half (40, 80, 220).
const std::string kJpeg = from_hex(
    "ffd8ffe000104a46494600010100000100010000ffdb00430003020203020203030303040303040508050504"
    "04050a070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f1718161418121415"
    "14ffdb00430103040405040509050509140d0b0d141414141414141414141414141414141414141414141414"
    "1414141414141414141414141414141414141414141414141414ffc000110800080010030111000211010311"
    "01ffc4001500010100000000000000000000000000000507ffc4001410010000000000000000000000000000"
    "0000ffc400160101010100000000000000000000000000090708ffc400141101000000000000000000000000"
    "00000000ffda000c03010002110311003f0093a78d9008880e47ffd9");
// Grey 77.
const std::string kGreyJpeg = from_hex(
    "ffd8ffe000104a46494600010100000100010000ffdb00430003020203020203030303040303040508050504"
    "04050a070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f1718161418121415"
    "14ffc0000b080008000801011100ffc40014000100000000000000000000000000000008ffc4001410010000"
    "0000000000000000000000000000ffda0008010100003f003bbfffd9");
const std::string kCmykJpeg = from_hex(
    "ffd8ffee000e41646f626500640000000000ffdb004300030202030202030303030403030405080505040405"
    "0a070706080c0a0c0c0b0a0b0b0d0e12100d0e110e0b0b1016101113141515150c0f171816141812141514ff"
    "c000140800080008044311004d11005911004b1100ffc40014000100000000000000000000000000000008ff"
    "c40014100100000000000000000000000000000000ffda000e0443004d0059004b00003f004290a4290affd9");

TEST(Jpeg, ColourAndGreyAreReadAsRgb) {
  const auto image = read(kJpeg);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->width, 16);
  EXPECT_EQ(image->height, 8);
  ASSERT_EQ(image->data.size(), 3u * 16 * 8);
  for (std::size_t k = 0; k < 3; ++k) {  // 2: what its quantisation leaves
    EXPECT_NEAR(image->data[k], (std::array{200, 50, 50})[k], 2);
    EXPECT_NEAR(image->data[3 * 127 + k], (std::array{40, 80, 220})[k], 2);
  }
  const auto grey = read(kGreyJpeg);
  ASSERT_TRUE(grey) << grey.error().message;
  EXPECT_EQ(grey->channels, 3);
  EXPECT_EQ(grey->data, std::vector<std::uint8_t>(3 * 64, 77));
}

TEST(Jpeg, EveryTruncationIsAnError) {
  for (const std::string& whole : {kJpeg, kGreyJpeg})
    for (std::size_t size = 0; size < whole.size(); ++size) {
      const auto image = read(whole.substr(0, size));
      ASSERT_FALSE(image) << size << " of " << whole.size() << " bytes";
      EXPECT_EQ(image.error().code, Errc::kInvalidInput);
    }
}

TEST(Jpeg, CmykIsRefused) {
  const auto image = read(kCmykJpeg);
  ASSERT_FALSE(image);
  EXPECT_THAT(image.error().message, HasSubstr("CMYK"));
}

/// Grey 8 x 8, every coefficient above the mean in scans of its own, a bit of each at a time; the
/// first so many of these scans.
std::string jpeg_of_scans(std::size_t count) {
  jpeg_error_mgr errors;
  jpeg_compress_struct info;
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* data = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &data, &size);
  info.image_width = info.image_height = 8;
  info.input_components = 1;
  info.in_color_space = JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  std::vector<jpeg_scan_info> scans = {{1, {0, 0, 0, 0}, 0, 0, 0, 0}};
  for (int k = 1; k < 64; ++k)
    for (int bit = 4; bit >= 0; --bit)
      scans.push_back({1, {0, 0, 0, 0}, k, k, bit == 4 ? 0 : bit + 1, bit});
  scans.resize(std::min(count, scans.size()));
  info.scan_info = scans.data();
  info.num_scans = static_cast<int>(scans.size());
  jpeg_start_compress(&info, TRUE);
  std::array<JSAMPLE, 8> samples{0, 255, 3, 77, 200, 9, 128, 31};
  JSAMPROW row = samples.data();
  for (int y = 0; y < 8; ++y) jpeg_write_scanlines(&info, &row, 1);
  jpeg_finish_compress(&info);
  std::string file(reinterpret_cast<const char*>(data), size);
  jpeg_destroy_compress(&info);
  std::free(data);
  return file;
}

TEST(Jpeg, MoreScansThanAPhotographHasAreRefused) {
  const auto image = read(jpeg_of_scans(201));
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, Errc::kInvalidInput);
  EXPECT_THAT(image.error().message, HasSubstr("more than 200 scans"));
  const auto most = read(jpeg_of_scans(200));
  EXPECT_TRUE(most) << most.error().message;
}

/// The file with other sides in its frame header, and zeros behind its end.
std::string with_sides(std::string file, int side, std::size_t size) {
  const std::size_t frame = file.find("\xFF\xC2");
  file.replace(frame + 5, 4, bytes({side >> 8, side & 255, side >> 8, side & 255}));
  file.resize(std::max(size, file.size()));
  return file;
}

TEST(Jpeg, ScansTimesPixelsAreRefusedBeforeTimeIsSpentOnThem) {
  constexpr std::size_t kPaid = std::size_t{1} << 28 >> 12;  // for a picture of 2^28 pixels
  for (const std::size_t scans : {std::size_t{17}, std::size_t{200}}) {
    const std::clock_t before = std::clock();
    const auto image = read(with_sides(jpeg_of_scans(scans), 16384, kPaid));
    EXPECT_LT(std::clock() - before, CLOCKS_PER_SEC / 20) << scans;
    ASSERT_FALSE(image);
    EXPECT_EQ(image.error().code, Errc::kInvalidInput);
    EXPECT_THAT(image.error().message, HasSubstr("more than 16 scans of 16384 x 16384 pixels"));
  }
}

TEST(ImageSize, IsReadFromTheHeaderAlone) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a.png", png(300, 2, 8, 2, "no rows").substr(0, 33));
  const auto size = read_image_size(directory / "a.png");
  ASSERT_TRUE(size) << size.error().message;
  EXPECT_EQ(size->width, 300u);
  EXPECT_EQ(size->height, 2u);
  // 60,000 bytes of EXIF in front of the frame header.
  const std::string exif =
      bytes({0xFF, 0xE1, 60000 >> 8, 60000 & 255}) + std::string(60000 - 2, 'x');
  test::write_text(directory / "b.jpg", kJpeg.substr(0, 2) + exif + kJpeg.substr(2, 170));
  const auto jpeg = read_image_size(directory / "b.jpg");
  ASSERT_TRUE(jpeg) << jpeg.error().message;
  EXPECT_EQ(jpeg->width, 16u);
  EXPECT_EQ(jpeg->height, 8u);
}

}  // namespace
}  // namespace slf::jpeg_reading_test
