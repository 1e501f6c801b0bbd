// SPDX-License-Identifier: Apache-2.0
// Splats in zstd (SPZ 4) and in WebP (SOG).
#include "gaussian_bundles.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

namespace slf::gaussian_bundles_test {
namespace {

using test::random_gaussians;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

#if SLF_WITH_ZSTD
TEST(GaussianBundles, Spz4SaysWhatSpz3Says) {
  const Bytes spz3 = *gaussian_file(random_gaussians(40, 1), SplatFormat::kSpz3);
  const auto three = parse_gaussians("x", spz3), four = parse_gaussians("x", test::spz4_of(spz3));
  ASSERT_TRUE(four) << four.error().message;
  EXPECT_EQ(four->format, "SPZ 4");
  EXPECT_EQ(four->gaussians.positions, three->gaussians.positions);
  EXPECT_EQ(four->gaussians.rotations, three->gaussians.rotations);
  EXPECT_EQ(four->gaussians.logits, three->gaussians.logits);
  EXPECT_EQ(four->gaussians.harmonics, three->gaussians.harmonics);
}

TEST(GaussianBundles, AttributesOfSpz4ThatAreDamagedAreNamed) {
  const Bytes whole = test::spz4_of(*gaussian_file(random_gaussians(40, 1), SplatFormat::kSpz3));
  const auto refused = [&](std::size_t at, int byte, const std::string& cause) {
    Bytes changed = whole;
    changed[at] = static_cast<std::uint8_t>(byte);
    const auto file = parse_gaussians("x", changed);
    ASSERT_FALSE(file) << at;
    EXPECT_THAT(file.error().message, HasSubstr(cause));
  };
  refused(15, 5, "5 attributes");
  refused(17, 255, "list of attributes");
  refused(40 + 7, 1, "attribute 0 is cut off");
  refused(40 + 16 + 8, 41, "attribute 1 is of another size");
  refused(40 + 6 * 16, 0, "attribute 0 is damaged");
  refused(4, 3, "version 3");
  refused(11, 1, "splats");  // 16 million in some hundred bytes
  Bytes more = whole;
  more.push_back(0);
  EXPECT_THAT(parse_gaussians("x", more).error().message, HasSubstr("behind the last"));
}
#endif

#if SLF_WITH_WEBP
void expect_two_splats(const GaussianFile& file) {
  const Gaussians& g = file.gaussians;
  EXPECT_EQ(file.format, "SOG 2");
  ASSERT_EQ(g.size(), 2u);
  EXPECT_EQ(g.degree, 1);
  EXPECT_EQ(g.up, UpAxis::kMinusY);
  EXPECT_THAT(g.positions[0], ElementsAre(static_cast<float>(std::expm1(1.0)), 0, 0));
  EXPECT_THAT(g.positions[1], ElementsAre(static_cast<float>(-std::expm1(1.0)),
                                          static_cast<float>(std::expm1(2.0)), 0));
  EXPECT_THAT(g.log_deviations[0], ElementsAre(-7, -6, -5));
  // The second of w, x, y, z is left out: 1/sqrt(2), and -1/sqrt(2) twice is more than is left.
  EXPECT_EQ(file.mended, 1u);  // the other's turn is of no kind
  EXPECT_THAT(g.rotations[1], ElementsAre(1, 0, 0, 0));
  EXPECT_NEAR(1 / (1 + std::exp(-g.logits[0])), 0.2, 1e-6);
  EXPECT_THAT(std::vector<float>(g.harmonics.begin(), g.harmonics.begin() + 12),
              ElementsAre(0.5f, -0.5f, 0.5f, 0, 0.25f, 0.75f, 0.25f, 0.25f, 0.25f, 0.75f, 0, 0));
  for (std::size_t i = 15; i < 24; ++i) EXPECT_EQ(g.harmonics[i], 0);
}

TEST(GaussianBundles, ASogIsReadFromItsBundleAndBesideItsText) {
  const auto files = test::sog_files();
  const Bytes zip = test::zip_of(files);
  EXPECT_TRUE(looks_like_gaussians(zip, zip.size()));
  const auto bundle = parse_gaussians("x", zip);
  ASSERT_TRUE(bundle) << bundle.error().message;
  expect_two_splats(*bundle);
  const auto folder = std::filesystem::path(testing::TempDir()) / "slf_sog";
  std::filesystem::create_directories(folder);
  for (const auto& [name, bytes] : files)
    std::ofstream(folder / name, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  const auto beside = read_gaussians(folder / "meta.json");
  ASSERT_TRUE(beside) << beside.error().message;
  expect_two_splats(*beside);
  std::filesystem::remove_all(folder);
}

TEST(GaussianBundles, WhatASogLacksOrOversaysIsNamed) {
  const auto refused = [](const char* from, const char* to, const std::string& cause) {
    auto files = test::sog_files();
    Bytes& meta = files["meta.json"];
    std::string text(meta.begin(), meta.end());
    text.replace(text.find(from), std::string(from).size(), to);
    meta.assign(text.begin(), text.end());
    const auto file = parse_gaussians("x", test::zip_of(files));
    ASSERT_FALSE(file) << to;
    EXPECT_THAT(file.error().message, HasSubstr(cause));
  };
  refused("\"version\": 2", "\"version\": 3", "version: only SOG 2");
  refused("\"version\": 2, ", "", "SOG 1");
  refused("\"count\": 2", "\"count\": 1000000", "count");
  refused("\"count\": 2", "\"count\": 9", "means.files[0]: a picture of fewer pixels");
  refused("\"count\": 2", "\"count\": 1.5", "count");
  refused("[-7, -6, -5]", "[]", "scales.codebook");
  refused("\"quats.webp\"", "\"quats.png\"", "quats.files[0]: no such file");
  refused("\"quats.webp\"", "\"meta.json\"", "quats.files[0]: not a WebP");
  refused(", \"means_u.webp\"", "", "means.files: a file is missing");
  refused("\"bands\": 1", "\"bands\": 2", "shN.files[0]: 64 vectors a row");
  refused("\"bands\": 1", "\"bands\": 4", "shN.bands");
  refused("{\"count\": 1,", "{\"count\": 65,", "shN.files[0]");
  refused("\"count\": 1,", "\"count\": 1e9,", "shN.count");
}
#endif

}  // namespace
}  // namespace slf::gaussian_bundles_test
