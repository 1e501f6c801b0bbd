// SPDX-License-Identifier: Apache-2.0
// Image-plus-geometry files that are damaged or do not fit, and captures that cannot be coded.
#include "igc_support.h"
#include "tools/rd/igc/igc_file.h"

namespace slf::igc_bad_input_test {
namespace {

using test::Igc;

TEST_F(Igc, DamageIsAnError) {
  SLF_NEEDS_HEVC();
  const std::vector<std::uint8_t> whole = encoded(settings(40)).stream;
  const Capture bare = calibration();
  EXPECT_TRUE(is_igc(whole));
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 331)
    EXPECT_FALSE(decode_igc(std::span(whole).first(size), bare)) << size << " bytes";
  for (std::size_t at = 0; at < whole.size(); at += at < 64 ? 1 : 331) {
    std::vector<std::uint8_t> damaged = whole;
    damaged[at] ^= 0x20;
    EXPECT_FALSE(decode_igc(damaged, bare)) << "byte " << at;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_EQ(decode_igc(longer, bare).error().code, Errc::kOutOfRange);
  EXPECT_EQ(decode_igc({}, bare).error().code, Errc::kNotSlf);
}

TEST_F(Igc, SectionsThatDoNotFitTogetherAreRefused) {
  SLF_NEEDS_HEVC();
  const auto a = encoded(settings(40)).stream, b = encoded(settings(40, IgcChroma::k444)).stream;
  const IgcSections one = *read_igc_file(a), other = *read_igc_file(b);
  const auto refused = [](IgcSections sections) {
    return !decode_igc(write_igc_file(sections), calibration());
  };
  EXPECT_FALSE(refused(one));
  EXPECT_TRUE(refused({one.parameters, one.geometry, other.images}));  // other chroma
  EXPECT_TRUE(refused({one.parameters, one.images, one.geometry}));    // swapped
  EXPECT_TRUE(refused({{}, one.geometry, one.images}));
  EXPECT_TRUE(refused({one.parameters, one.geometry, {}}));
}

TEST_F(Igc, TheCamerasOfTheFileMustBeTheCaptures) {
  SLF_NEEDS_HEVC();
  const auto stream = encoded(settings(40)).stream;
  Capture renamed = calibration(), resized = calibration(), none;
  renamed.cameras[static_cast<std::size_t>(cameras_[0])].name = "another";
  resized.cameras[static_cast<std::size_t>(cameras_[0])].width += 1;
  for (const Capture& capture : {renamed, resized, none})
    EXPECT_EQ(decode_igc(stream, capture).error().code, Errc::kInvalidInput);
  IgcDecodeOptions options;
  options.limits.max_memory = 100000;
  EXPECT_EQ(decode_igc(stream, capture_, options).error().code, Errc::kLimitExceeded);
}

TEST_F(Igc, WhatCannotBeEncodedIsRefused) {
  Capture uneven = capture_;
  uneven.cameras[static_cast<std::size_t>(cameras_[3])].width = 80;
  const auto mixed = encode_igc(uneven, cameras_, settings(30));
  ASSERT_FALSE(mixed);
  EXPECT_NE(
      mixed.error().message.find(capture_.cameras[static_cast<std::size_t>(cameras_[3])].name),
      std::string::npos);
  EXPECT_FALSE(encode_igc(capture_, {}, settings(30)));
  EXPECT_FALSE(encode_igc(capture_, std::vector{9999}, settings(30)));
  SLF_NEEDS_HEVC();
  EXPECT_FALSE(encode_igc(capture_, cameras_, settings(60)));
  Capture missing = capture_;
  missing.image_files[static_cast<std::size_t>(cameras_[2])] = "/nowhere/image.png";
  EXPECT_EQ(encode_igc(missing, cameras_, settings(30)).error().code, Errc::kUnreadable);
  Capture names = capture_;
  names.cameras[static_cast<std::size_t>(cameras_[0])].name = "two\nlines";
  EXPECT_EQ(encode_igc(names, cameras_, settings(30)).error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace slf::igc_bad_input_test
