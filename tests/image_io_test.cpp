// PNG and JPEG in, PNG out, and files that appear whole or not at all.
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <zlib.h>

#include <csignal>
#include <cstdio>
#include <thread>
// jpeglib.h needs stdio.
#include <jpeglib.h>

#include "capture/image_formats.h"
#include "capture_support.h"

namespace slf {
namespace {

using test::ByteString;
using test::TemporaryDirectory;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// PNG by hand, so that it is not libpng that tests libpng.
std::string chunk(const std::string& type, const std::string& data) {
  const std::string covered = type + data;
  ByteString out;
  out.put(static_cast<std::uint32_t>(data.size()), true).text(covered);
  const auto crc =
      ::crc32(0, reinterpret_cast<const Bytef*>(covered.data()), static_cast<uInt>(covered.size()));
  return out.put(static_cast<std::uint32_t>(crc), true).bytes;
}

std::string deflated(const std::string& raw) {
  uLongf size = ::compressBound(raw.size());
  std::string out(size, '\0');
  EXPECT_EQ(::compress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(raw.data()), raw.size()),
            Z_OK);
  out.resize(size);
  return out;
}

// @param rows  filter type 0 and samples of each row
std::string png(std::uint32_t width, std::uint32_t height, int depth, int colour_type,
                const std::string& rows, const std::string& before_data = "") {
  ByteString header;
  header.put(width, true).put(height, true);
  header.put(std::uint8_t(depth)).put(std::uint8_t(colour_type)).text(std::string(3, '\0'));
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header.bytes) + before_data +
         chunk("IDAT", deflated(rows)) + chunk("IEND", "");
}

std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

std::string from_hex(const std::string& hex) {
  std::string text;
  for (std::size_t i = 0; i < hex.size(); i += 2)
    text += static_cast<char>(std::stoi(hex.substr(i, 2), nullptr, 16));
  return text;
}

Result<Image, InputError> read(const std::string& file) {
  const TemporaryDirectory directory;
  test::write_text(directory / "image", file);
  return read_image(directory / "image");
}

struct Kind {
  const char* name;
  std::string file;
  int channels;
  std::vector<std::uint8_t> data;  // of 2 x 1 pixels
};
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

/// Grey 8 x 8, every coefficient above the mean in scans of its own, a bit of each at a time.
std::string jpeg_of_many_scans() {
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
  const auto image = read(jpeg_of_many_scans());
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, Errc::kInvalidInput);
  EXPECT_THAT(image.error().message, HasSubstr("more than 200 scans"));
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

TEST(WriteFile, ReplacesTheOldFileAndKeepsItsMode) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "old, and longer");
  ASSERT_EQ(::chmod((directory / "a").c_str(), 0640), 0);
  ASSERT_TRUE(write_file(directory / "a", "new", 3));
  EXPECT_EQ(test::read_text(directory / "a"), "new");
  struct stat status {};
  ASSERT_EQ(::stat((directory / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777, 0640u);
  EXPECT_EQ(directory.num_entries(), 1u);
}

TEST(WriteFile, FailsOnAFullDiskNamingFileAndCause) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  const auto written = write_file("/dev/full", "x", 1);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kUnwritable);
  EXPECT_EQ(written.error().message, "/dev/full: cannot be written: No space left on device");
}

TEST(WriteFile, FailsWithoutTheDirectoryAndOnADirectory) {
  const TemporaryDirectory directory;
  const auto missing = write_file(directory / "none/a", "x", 1);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().code, Errc::kUnwritable);
  EXPECT_THAT(missing.error().message, HasSubstr("none/a: cannot be written: No such file"));
  const auto onto = write_file(directory.path(), "x", 1);
  ASSERT_FALSE(onto);
  EXPECT_THAT(onto.error().message, HasSubstr("Is a directory"));
  EXPECT_EQ(directory.num_entries(), 0u);
}

// A file size limit stands in for a full disk: the write fails half way.
TEST(WriteFile, AFailedWriteLeavesTheOldFileAndNoOther) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "old");
  const std::string much(1 << 20, 'x');
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const rlimit small{4096, before.rlim_max};
  const auto handler = ::signal(SIGXFSZ, SIG_IGN);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  const auto written = write_file(directory / "a", much.data(), much.size());
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  ::signal(SIGXFSZ, handler);
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().code, Errc::kUnwritable);
  EXPECT_THAT(written.error().message, HasSubstr("/a: cannot be written: File too large"));
  EXPECT_EQ(test::read_text(directory / "a"), "old");
  EXPECT_EQ(directory.num_entries(), 1u);
}

TEST(WriteFile, GoesThroughSymbolicLinks) {
  const TemporaryDirectory directory;
  test::write_text(directory / "real/a", "old");
  std::filesystem::create_symlink(directory / "real/a", directory / "link");
  ASSERT_TRUE(write_file(directory / "link", "new", 3));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(test::read_text(directory / "real/a"), "new");
}

TEST(WriteFile, GoesThroughSymbolicLinksThatLeadToNothingYet) {
  const TemporaryDirectory directory;
  std::filesystem::create_symlink("real", directory / "link");
  ASSERT_TRUE(write_file(directory / "link", "new", 3));
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(test::read_text(directory / "real"), "new");
}

TEST(WriteFile, WritesIntoDevicesAndPipesThemselves) {
  EXPECT_TRUE(write_file("/dev/null", "x", 1));
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  const TemporaryDirectory directory;
  ASSERT_EQ(::mkfifo((directory / "pipe").c_str(), 0600), 0);
  std::thread writer([&] { EXPECT_TRUE(write_file(directory / "pipe", "through", 7)); });
  EXPECT_EQ(test::read_text(directory / "pipe"), "through");
  writer.join();
  EXPECT_TRUE(std::filesystem::is_fifo(directory / "pipe"));
}

TEST(ReadFile, RefusesMoreThanTheLimitAndDirectories) {
  const TemporaryDirectory directory;
  test::write_text(directory / "a", "12345");
  EXPECT_TRUE(read_file(directory / "a", 5));
  const auto large = read_file(directory / "a", 4);
  ASSERT_FALSE(large);
  EXPECT_EQ(large.error().code, Errc::kInvalidInput);
  const auto folder = read_file(directory.path());
  ASSERT_FALSE(folder);
  EXPECT_EQ(folder.error().code, Errc::kUnreadable);
}

}  // namespace
}  // namespace slf
