// SPDX-License-Identifier: Apache-2.0
// Files of splats: what is written is read again, what others write is read, what is damaged is
// refused.
#include <gmock/gmock.h>

#include <cstring>

#include "gaussian_support.h"
#include "lightfield/harmonics.h"
#include "lightfield/splats/turn_gaussians.h"
#include "splats_support.h"

namespace slf::gaussian_files_test {
namespace {

using test::ascii_header;
using test::bytes_of;
using test::random_gaussians;
using ::testing::ElementsAre;
using ::testing::FloatNear;
using ::testing::HasSubstr;
using ::testing::Pointwise;
using Bytes = std::vector<std::uint8_t>;

GaussianFile read(const Bytes& bytes) {
  EXPECT_TRUE(looks_like_gaussians(bytes, bytes.size()));
  auto file = parse_gaussians("x", bytes);
  EXPECT_TRUE(file) << file.error().message;
  return file ? *std::move(file) : GaussianFile{};
}

/// The same turn, whichever sign the quaternion has.
void expect_turn(const std::array<float, 4>& a, const std::array<float, 4>& b, float least) {
  const float product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  EXPECT_GT(std::abs(product), least);
}

TEST(GaussianFiles, APlyIsReadAgainAsItWasForEveryDegree) {
  for (int degree = 0; degree <= 4; ++degree) {
    const Gaussians before = random_gaussians(50, degree);
    const GaussianFile file = read(*gaussian_file(before, SplatFormat::kPly));
    const Gaussians& after = file.gaussians;
    EXPECT_EQ(file.format, "PLY");
    EXPECT_EQ(file.left_out + file.mended, 0u);
    EXPECT_EQ(after.degree, degree);
    EXPECT_EQ(after.up, UpAxis::kMinusY);
    EXPECT_EQ(after.positions, before.positions);
    EXPECT_EQ(after.log_deviations, before.log_deviations);
    EXPECT_EQ(after.logits, before.logits);
    EXPECT_EQ(after.harmonics, before.harmonics);
    for (std::size_t p = 0; p < 50; ++p)
      expect_turn(after.rotations[p], before.rotations[p], 0.999999f);
  }
}

// Position of 24 bits and more, sizes of 1/16, opacity and colours of bytes, harmonics of 1/32,
// rounded twice; a component of a turn has 1/127 or 1/722.
TEST(GaussianFiles, GlbAndSpzAreReadAgainWithinWhatTheyKeep) {
  Gaussians before = random_gaussians(200, 3);
  before.up = UpAxis::kPlusY;
  for (const auto& [format, name] : {std::pair{SplatFormat::kGlb, "glTF"},
                                     {SplatFormat::kSpz, "SPZ 2"},
                                     {SplatFormat::kSpz3, "SPZ 3"}}) {
    const bool spz = format != SplatFormat::kGlb;
    const GaussianFile file = read(*gaussian_file(before, format));
    const Gaussians& after = file.gaussians;
    EXPECT_EQ(file.format, name);
    EXPECT_EQ(after.up, UpAxis::kPlusY);
    ASSERT_EQ(after.size(), before.size());
    for (std::size_t p = 0; p < before.size(); ++p) {
      EXPECT_THAT(after.positions[p], Pointwise(FloatNear(1e-6f), before.positions[p]));
      EXPECT_THAT(after.log_deviations[p],
                  Pointwise(FloatNear(spz ? 0.032f : 1e-5f), before.log_deviations[p]));
      EXPECT_NEAR(1 / (1 + std::exp(-after.logits[p])), 1 / (1 + std::exp(-before.logits[p])),
                  spz ? 0.0021 : 1e-5);
      expect_turn(after.rotations[p], before.rotations[p],
                  format == SplatFormat::kSpz    ? 0.97f
                  : format == SplatFormat::kSpz3 ? 0.99999f
                                                 : 0.999999f);
    }
    EXPECT_THAT(after.harmonics, Pointwise(FloatNear(spz ? 0.02f : 0), before.harmonics));
  }
}

TEST(GaussianFiles, HigherDegreesThanAFormatHasAreCut) {
  for (const SplatFormat format : {SplatFormat::kGlb, SplatFormat::kSpz3})
    EXPECT_EQ(read(*gaussian_file(random_gaussians(5, 4), format)).gaussians.degree, 3);
}

/// Colour of a splat along a direction, less a half.
double colour(const Gaussians& g, std::size_t p, const Vec3& direction) {
  std::vector<double> row(g.num_harmonics());
  Harmonics(g.degree).evaluate(direction, row.data());
  double sum = 0;
  for (std::size_t k = 0; k < row.size(); ++k)
    sum += row[k] * double{g.harmonics[3 * (p * row.size() + k)]};
  return sum;
}

TEST(GaussianFiles, AnyUpAxisEndsUpWhereTheFormatHasItAndColoursTurnWithIt) {
  const Vec3 direction{0.48, -0.6, 0.64};
  for (int up = 0; up <= 6; ++up) {
    Gaussians before = random_gaussians(10, 4);
    before.up = static_cast<UpAxis>(up);
    LightFieldHeader header;
    header.up = before.up == UpAxis::kUnknown ? UpAxis::kMinusY : before.up;
    for (const SplatAxes axes : {SplatAxes::kYUp, SplatAxes::kYDown}) {
      const AxisRows rows = axis_rows(header, axes);
      const Gaussians after = in_axes(before, axes);
      for (std::size_t p = 0; p < before.size(); ++p) {
        const auto& b = before.positions[p];
        const Vec3 at = turned(rows, {double{b[0]}, double{b[1]}, double{b[2]}});
        for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(double{after.positions[p][k]}, at[k], 1e-6);
        EXPECT_NEAR(colour(after, p, turned(rows, direction)), colour(before, p, direction), 1e-5);
      }
    }
  }
}

TEST(GaussianFiles, ATurnByHalfAboutXLosesNoDigit) {
  const Gaussians before = random_gaussians(20, 4);
  Gaussians there = in_axes(before, SplatAxes::kYUp);
  EXPECT_EQ(there.up, UpAxis::kPlusY);
  EXPECT_EQ(there.positions[3][1], -before.positions[3][1]);
  const Gaussians back = in_axes(there, SplatAxes::kYDown);
  EXPECT_EQ(back.positions, before.positions);
  EXPECT_EQ(back.harmonics, before.harmonics);
}

TEST(GaussianFiles, TurnsOfAnyAngleKeepWhatIsSeen) {
  const double c = std::cos(0.7), s = std::sin(0.7);
  const AxisRows rows{{{c, -s, 0}, {0.6 * s, 0.6 * c, -0.8}, {0.8 * s, 0.8 * c, 0.6}}};
  const Gaussians before = random_gaussians(5, 4);
  Gaussians after = before;
  move_gaussians(after, rows, 1);
  for (const Vec3& v : {Vec3{0, 0, 1}, {0.6, 0.8, 0}, {-0.48, 0.6, 0.64}})
    for (std::size_t p = 0; p < 5; ++p)
      EXPECT_NEAR(colour(after, p, turned(rows, v)), colour(before, p, v), 1e-5);
}

TEST(GaussianFiles, DiscsOfALightFieldAreTheGaussiansThatTheirFileHas) {
  const ViewMaps maps(test::harmonic_ball(Directions::kWorld));
  const auto discs = make_splats(maps, {.axes = SplatAxes::kYDown});
  ASSERT_TRUE(discs);
  const Gaussians made = gaussians_of(*discs, UpAxis::kMinusY);
  const Gaussians file = read(*splat_file(*discs, SplatFormat::kPly)).gaussians;
  EXPECT_EQ(made.positions, file.positions);
  EXPECT_EQ(made.log_deviations, file.log_deviations);
  EXPECT_EQ(made.logits, file.logits);
  EXPECT_EQ(made.harmonics, file.harmonics);
}

TEST(GaussianFiles, AsciiAndOtherNamesAndDiscsWithoutThicknessAreRead) {
  const auto file = read(bytes_of(
      ascii_header(1, {"z", "y", "x", "red", "green", "blue", "opacities", "scaling_0", "scaling_1",
                       "rotation_0", "rotation_1", "rotation_2", "rotation_3"}) +
      "3 2 1 1 0.5 0 -1 -2 -3 0 0 2 0\n"));
  const Gaussians& g = file.gaussians;
  EXPECT_THAT(g.positions, ElementsAre(std::array<float, 3>{1, 2, 3}));
  EXPECT_THAT(g.rotations, ElementsAre(std::array<float, 4>{0, 0, 1, 0}));
  EXPECT_THAT(g.log_deviations, ElementsAre(std::array<float, 3>{-2, -3, -8}));
  EXPECT_NEAR(g.harmonics[0], 0.5 / 0.28209479, 1e-6);
  EXPECT_EQ(g.harmonics[1], 0);
}

TEST(GaussianFiles, ASplatOf32BytesIsRead) {
  const auto file = read(test::splat_bytes(5));
  const Gaussians& g = file.gaussians;
  EXPECT_EQ(file.format, "splat");
  ASSERT_EQ(g.size(), 5u);
  EXPECT_THAT(g.positions[2], ElementsAre(1, -2, 3));
  EXPECT_NEAR(g.log_deviations[2][1], std::log(0.2), 1e-6);
  EXPECT_THAT(g.rotations[2], ElementsAre(0, 0, -1, 0));
  EXPECT_NEAR(1 / (1 + std::exp(-g.logits[2])), 0.8, 1e-6);
  EXPECT_NEAR(g.harmonics[0], 0.5 / 0.28209479, 1e-6);
  Bytes odd = test::splat_bytes(5);
  odd.pop_back();
  EXPECT_FALSE(looks_like_gaussians(odd, odd.size()));
  EXPECT_FALSE(looks_like_gaussians(Bytes(64, 'a'), 64));
}

TEST(GaussianFiles, AKsplatOfFloatsAndOneOfHalvesAreRead) {
  const Gaussians floats = read(test::ksplat_bytes(0)).gaussians;
  ASSERT_EQ(floats.size(), 2u);
  EXPECT_EQ(floats.degree, 1);
  EXPECT_THAT(floats.positions[1], ElementsAre(3, 4, 5));
  EXPECT_NEAR(floats.log_deviations[1][0], std::log(0.5), 1e-6);
  EXPECT_THAT(floats.rotations[0], ElementsAre(0, 0, 1, 0));
  // Red has the first three of nine, one for each function.
  EXPECT_EQ(floats.harmonics[3], 0);
  EXPECT_EQ(floats.harmonics[4], 3);
  EXPECT_EQ(floats.harmonics[9], 2);
  const Gaussians halves = read(test::ksplat_bytes(1)).gaussians;
  ASSERT_EQ(halves.size(), 2u);
  EXPECT_THAT(halves.positions[0], ElementsAre(11, 20, 30));
  EXPECT_THAT(halves.positions[1], ElementsAre(-9, -20, -30));
  EXPECT_EQ(halves.harmonics[7], 2);  // green, second function
}

TEST(GaussianFiles, ACompressedPlyIsReadBetweenItsBounds) {
  const auto file = read(test::compressed_ply_bytes());
  const Gaussians& g = file.gaussians;
  EXPECT_EQ(file.format, "compressed PLY");
  ASSERT_EQ(g.size(), 2u);
  EXPECT_EQ(g.degree, 1);
  EXPECT_THAT(g.positions,
              ElementsAre(std::array<float, 3>{-1, -2, -3}, std::array<float, 3>{1, 2, 3}));
  EXPECT_THAT(g.log_deviations[0], ElementsAre(-2, -2, -2));
  EXPECT_NEAR(g.rotations[0][0], 1, 1e-5);
  EXPECT_EQ(g.harmonics[3 + 0], -4);  // red, first function
  EXPECT_EQ(g.harmonics[3 + 1], 4);   // green
}

TEST(GaussianFiles, NodesOfAGltfMoveTurnAndScaleTheirSplats) {
  Gaussians before = random_gaussians(4, 1);
  before.up = UpAxis::kPlusY;
  Bytes glb = *gaussian_file(before, SplatFormat::kGlb);
  std::string text(glb.begin(), glb.end());
  const std::string node = R"({"mesh":0})";
  // A quarter turn about y, twice the size; the JSON grows by whole words.
  std::string put =
      R"({"mesh":0,"translation":[1,2,3],"scale":[2,2,2],"rotation":[0,0.70710678,0,0.70710678]})";
  put.resize(node.size() + (put.size() - node.size() + 3) / 4 * 4, ' ');
  text.replace(text.find(node), node.size(), put);
  const auto add = [&](std::size_t at, std::size_t more) {
    std::uint32_t word = 0;
    std::memcpy(&word, &text[at], 4);
    word += static_cast<std::uint32_t>(more);
    std::memcpy(&text[at], &word, 4);
  };
  add(8, put.size() - node.size());
  add(12, put.size() - node.size());
  const Gaussians after = read(bytes_of(text)).gaussians;
  ASSERT_EQ(after.size(), 4u);
  const auto& b = before.positions[0];
  EXPECT_THAT(after.positions[0],
              Pointwise(FloatNear(1e-5f), {2 * b[2] + 1, 2 * b[1] + 2, -2 * b[0] + 3}));
  EXPECT_NEAR(after.log_deviations[0][0], before.log_deviations[0][0] + std::log(2.0), 1e-5);
  EXPECT_NEAR(colour(after, 0, {0, 0, -1}), colour(before, 0, {1, 0, 0}), 1e-5);
}

}  // namespace
}  // namespace slf::gaussian_files_test
