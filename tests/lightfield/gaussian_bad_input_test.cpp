// SPDX-License-Identifier: Apache-2.0
// Files of splats that are damaged, or whose values mean nothing.
#include <gmock/gmock.h>

#include "bitstream/encoder/deflate.h"
#include "gaussian_bundles.h"

namespace slf::gaussian_bad_input_test {
namespace {

using test::ascii_header;
using test::bytes_of;
using test::FileOfBytes;
using test::kSplatNames;
using test::random_gaussians;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

void expect_sane(const Gaussians& g) {
  const auto finite = [](auto&& values) {
    for (const float x : values)
      if (!std::isfinite(x)) return false;
    return true;
  };
  for (std::size_t p = 0; p < g.size(); ++p) {
    ASSERT_TRUE(finite(g.positions[p]) && finite(g.log_deviations[p]) && finite(g.rotations[p]));
    ASSERT_TRUE(std::isfinite(g.logits[p]));
  }
  EXPECT_TRUE(finite(g.harmonics));
  EXPECT_EQ(g.harmonics.size(), 3 * g.num_harmonics() * g.size());
}

TEST(GaussianBadInput, ValuesThatMeanNothingLeaveTheirSplatOutAndOthersAreMoved) {
  const auto file = parse_gaussians(
      "x", bytes_of(ascii_header(9, kSplatNames) + "0 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n"
                                                   "nan 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n"
                                                   "0 inf 0 0 0 0 0 -3 -3 -3 1 0 0 0\n"
                                                   "0 0 0 nan 0 0 0 -3 -3 -3 1 0 0 0\n"
                                                   "0 0 0 0 0 0 nan -3 -3 -3 1 0 0 0\n"
                                                   "0 0 0 0 0 0 0 -3 inf -3 1 0 0 0\n"
                                                   "0 0 0 0 0 0 inf -3 -3 -3 1 0 0 0\n"
                                                   "0 0 0 0 0 0 0 -3 -3 -inf 1 0 0 0\n"
                                                   "0 0 0 0 0 0 0 -3 -3 -3 0 0 0 0\n"));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->gaussians.size(), 4u);
  EXPECT_EQ(file->left_out, 5u);
  EXPECT_EQ(file->mended, 3u);
  EXPECT_THAT(file->gaussians.rotations.back(), ElementsAre(1, 0, 0, 0));
  expect_sane(file->gaussians);
  const auto none = parse_gaussians(
      "x", bytes_of(ascii_header(1, kSplatNames) + "nan 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n"));
  EXPECT_THAT(none.error().message, HasSubstr("none of its 1 splats"));
}

TEST(GaussianBadInput, HarmonicsOfNoDegreeAndFilesThatAreCutOffAreRefusedByName) {
  auto names = kSplatNames;
  for (int i = 0; i < 8; ++i) names.push_back("f_rest_" + std::to_string(i));
  auto file = parse_gaussians("x", bytes_of(ascii_header(0, names)));
  EXPECT_THAT(file.error().message, HasSubstr("8 properties f_rest_"));
  file = parse_gaussians("x",
                         bytes_of(ascii_header(1, kSplatNames) + "0 0 0 0 0 0 0 -3 -3 -3 1 0 0 a"));
  EXPECT_THAT(file.error().message, HasSubstr("'vertex', row 0"));
  file = parse_gaussians("x", bytes_of(ascii_header(100000000, kSplatNames)));
  EXPECT_THAT(file.error().message, HasSubstr("100000000"));
  EXPECT_THAT(parse_gaussians("x", bytes_of(ascii_header(0, kSplatNames))).error().message,
              HasSubstr("has no splats"));
  names.assign(kSplatNames.begin(), kSplatNames.begin() + 6);
  EXPECT_FALSE(looks_like_gaussians(bytes_of(ascii_header(1, names)), 1000));
}

TEST(GaussianBadInput, AHarmonicThatIsMissingAmongOthersIsNamed) {
  for (const std::string prefix : {"f_rest_", "features_rest_"})
    for (const int missing : {0, 9, 24, 25, 40}) {
      auto names = kSplatNames;
      for (int i = 0; i < 45; ++i)
        if (i != missing) names.push_back(prefix + std::to_string(i));
      const auto file = parse_gaussians("x", bytes_of(ascii_header(0, names)));
      ASSERT_FALSE(file);
      std::string wanted = "no " + prefix;
      EXPECT_THAT(file.error().message, HasSubstr(wanted.append(std::to_string(missing))));
    }
}

#if !SLF_WITH_ZSTD && !SLF_WITH_WEBP
TEST(GaussianBadInput, WhatNeedsOtherLibrariesIsRefusedByNameWithAWayOut) {
  FileOfBytes spz4;
  spz4.text("NGSP").integer(4, 4).up_to(64);
  FileOfBytes sog;
  sog.text("PK\3\4").up_to(30).text("meta.json");
  for (const Bytes& bytes : {spz4.bytes, sog.bytes}) {
    EXPECT_TRUE(looks_like_gaussians(bytes, bytes.size()));
    const auto file = parse_gaussians("x", bytes);
    EXPECT_EQ(file.error().code, Errc::kUnsupported);
    EXPECT_THAT(file.error().message, HasSubstr("splat-transform"));
  }
}
#endif

/// Small files of every format.
std::vector<Bytes> all_formats() {
  const Gaussians g = random_gaussians(3, 1);
  std::vector<Bytes> files{test::splat_bytes(3), test::ksplat_bytes(0), test::ksplat_bytes(1),
                           test::compressed_ply_bytes()};
  for (const SplatFormat format :
       {SplatFormat::kPly, SplatFormat::kGlb, SplatFormat::kSpz, SplatFormat::kSpz3})
    files.push_back(*gaussian_file(g, format));
#if SLF_WITH_ZSTD
  files.push_back(test::spz4_of(files.back()));
#endif
#if SLF_WITH_WEBP
  files.push_back(test::zip_of(test::sog_files()));
#endif
  files.push_back(bytes_of(ascii_header(2, kSplatNames) +
                           "0 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n1 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n"));
  return files;
}

TEST(GaussianBadInput, EveryTruncationEndsInSplatsOrAnError) {
  for (const Bytes& whole : all_formats())
    for (std::size_t size = 0; size<whole.size(); size += size> 512 && size < 4000 ? 97 : 1) {
      // A fresh exact-size buffer, so AddressSanitizer sees a read one byte too far.
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
      (void)looks_like_gaussians(cut, cut.size());
      if (const auto file = parse_gaussians("x", cut)) expect_sane(file->gaussians);
    }
}

TEST(GaussianBadInput, EveryChangedByteEndsInSplatsOrAnError) {
  for (const Bytes& whole : all_formats())
    for (std::size_t i = 0; i<whole.size(); i += i> 64 && i < 4000 && whole.size() > 5000 ? 97 : 1)
      for (const int change : {1, 0x80, 0xff}) {
        Bytes changed = whole;
        changed[i] = static_cast<std::uint8_t>(changed[i] ^ change);
        if (const auto file = parse_gaussians("x", changed)) expect_sane(file->gaussians);
      }
}

TEST(GaussianBadInput, CountsOfSpzAreComparedWithItsBytes) {
  FileOfBytes head;
  head.text("NGSP").integer(2, 4).integer(100000000, 4).integer(3, 1).integer(12, 1).integer(0, 2);
  const std::vector<std::uint8_t> file = gzip(head.bytes);
  EXPECT_THAT(parse_gaussians("x", file).error().message, HasSubstr("100000000 splats"));
  const auto unpacked = gunzip(file, 1000);
  EXPECT_EQ(unpacked.bytes, head.bytes);
  EXPECT_TRUE(unpacked.whole);
  EXPECT_EQ(gunzip(file, 5).bytes.size(), 5u);
}

}  // namespace
}  // namespace slf::gaussian_bad_input_test
