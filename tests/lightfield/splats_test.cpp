// SPDX-License-Identifier: Apache-2.0
// Splats made of a light field say what the light field says, in every frame and every axes.
#include "splats_support.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <nlohmann/json.hpp>
#include <string>

#include "lightfield/splats/splat_axes.h"
#include "lightfield/splats/splat_writers.h"

namespace slf {

static void PrintTo(Directions frame, std::ostream* out) {
  *out << (frame == Directions::kWorld ? "global" : "reflected");
}

}  // namespace slf

namespace slf::splats_test {
namespace {

using test::harmonic_ball;

SplatCloud splats_of(const ViewMaps& maps, const SplatSettings& settings = {}) {
  auto splats = make_splats(maps, settings);
  EXPECT_TRUE(splats);
  return *std::move(splats);
}

float dot(const std::array<float, 3>& a, const Vec3& b) {
  return a[0] * float(b[0]) + a[1] * float(b[1]) + a[2] * float(b[2]);
}

class SplatFrameTest : public testing::TestWithParam<Directions> {};

// A mirror at the normal is a half turn about it, so degree 3 stays degree 3: nothing but the
// smoothness of the fit and a table's rounding may differ. 1 level of 255 is 48 dB.
TEST_P(SplatFrameTest, HarmonicsOfDegreeThreeAreFoundAgainInWorldAxes) {
  const ViewMaps maps(harmonic_ball(GetParam()));
  const SplatCloud splats = splats_of(maps);
  const SplatLoss loss = splat_loss(maps, splats);
  EXPECT_GT(loss.psnr, 48);
  EXPECT_LT(loss.psnr_one_colour, 30) << "the maps have to differ over directions";
}

TEST_P(SplatFrameTest, RadianceIsThatOfTheLightFieldSeenFromTheOtherEnd) {
  const ViewMaps maps(harmonic_ball(GetParam()));
  for (const SplatAxes axes : {SplatAxes::kWorld, SplatAxes::kYUp, SplatAxes::kYDown}) {
    SplatSettings settings;
    settings.axes = axes;
    const SplatCloud splats = splats_of(maps, settings);
    for (std::size_t p = 0; p < splats.size(); p += 17) {
      const auto& n = splats.normals[p];
      const Vec3 outward = turned_back(splats.axes, {double{n[0]}, double{n[1]}, double{n[2]}});
      const auto [theta, gamma] = direction_of(outward);
      const auto splat = radiance_of(splats, p, {-double{n[0]}, -double{n[1]}, -double{n[2]}});
      const auto map = maps.radiance(p, theta, gamma);
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(splat[c], map[c], 2) << p;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Frames, SplatFrameTest,
                         testing::Values(Directions::kWorld, Directions::kReflected),
                         testing::PrintToStringParamName());

TEST(SplatTest, NormalsPointOutOfABallAndItsPointsAreSeenFromThereAlone) {
  const LightField field = harmonic_ball(Directions::kWorld, 6);
  const ViewMaps maps(field);
  const SplatCloud splats = splats_of(maps, {.axes = SplatAxes::kWorld});
  const Vec3 centre = field.header.grid.world({31, 31, 31});
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const Vec3 at = field.header.grid.world(field.positions[p]);
    EXPECT_GT(dot(splats.normals[p], {at[0] - centre[0], at[1] - centre[1], at[2] - centre[2]}), 0);
    EXPECT_GT(splats.front[p], 0.9f);
  }
}

TEST(SplatTest, AnyUpAxisEndsUpWhereTheFileWantsItAndAxesStayRightHanded) {
  for (int up = 0; up < 6; ++up) {
    LightFieldHeader header;
    header.up = static_cast<UpAxis>(up);
    Vec3 upward{0, 0, 0};
    upward[std::size_t(up) / 2] = up % 2 == 0 ? 1 : -1;
    for (const auto& [axes, y] : {std::pair{SplatAxes::kYUp, 1.0}, {SplatAxes::kYDown, -1.0}}) {
      const AxisRows rows = axis_rows(header, axes);
      EXPECT_EQ(turned(rows, upward), (Vec3{0, y, 0})) << up;
      const Vec3& a = rows[0];
      const Vec3& b = rows[1];
      const Vec3 third{a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                       a[0] * b[1] - a[1] * b[0]};
      EXPECT_EQ(third, rows[2]) << up;
    }
  }
}

TEST(SplatTest, ALeftHandedWorldIsMirrored) {
  LightField field = harmonic_ball(Directions::kWorld);
  field.header.right_handed = false;
  const ViewMaps maps(field);
  const SplatCloud splats = splats_of(maps);
  EXPECT_LT(splats.positions[0][0] * (field.header.grid.world(field.positions[0])[0]), 0);
  EXPECT_GT(splat_loss(maps, splats).psnr, 48);
}

TEST(SplatTest, LinearLightBecomesDisplayValues) {
  LightField field = harmonic_ball(Directions::kWorld);
  field.header.transfer = Transfer::kLinear;
  std::fill(field.components.begin(), field.components.end(), 0);
  for (std::size_t i = 0; i < field.components.size(); i += 48)
    for (std::size_t c = 0; c < 3; ++c) field.components[i + c] = 16 * 55;  // 21.57 % of 255
  const ViewMaps maps(field);
  const auto grey = radiance_of(splats_of(maps), 3, {0, 0, 1});
  for (const float c : grey) EXPECT_NEAR(c, 127.9f, 0.5f);  // IEC 61966-2-1 of 0.2157: 0.5017
}

TEST(SplatTest, CoordinatesFarFromTheOriginAreGivenFromTheMiddleOfTheCloud) {
  LightField field = harmonic_ball(Directions::kWorld);
  field.header.grid.origin = {4e6, -5e6, 300};
  const ViewMaps maps(field);
  const SplatCloud splats = splats_of(maps, {.axes = SplatAxes::kWorld});
  for (std::size_t p = 0; p < splats.size(); ++p) {
    const Vec3 at = field.header.grid.world(field.positions[p]);
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(splats.origin[k] + double{splats.positions[p][k]}, at[k],
                  0.7 * field.header.grid.step);  // discs move half a voxel onto the surface
  }
  EXPECT_GT(splat_loss(maps, splats).psnr, 48);
}

TEST(SplatTest, TheNumberOfThreadsChangesNoByte) {
  const ViewMaps maps(harmonic_ball(Directions::kReflected));
  SplatSettings one, three;
  one.threads = 1;
  three.threads = 3;
  for (const SplatFormat format : {SplatFormat::kPly, SplatFormat::kGlb, SplatFormat::kSpz})
    EXPECT_EQ(*splat_file(splats_of(maps, one), format),
              *splat_file(splats_of(maps, three), format));
}

TEST(SplatTest, LowerDegreesLoseMoreAndSpzMoreThanPly) {
  const ViewMaps maps(harmonic_ball(Directions::kWorld));
  double before = 0;
  for (int degree = 0; degree <= 3; ++degree) {
    SplatSettings settings;
    settings.degree = degree;
    const SplatCloud splats = splats_of(maps, settings);
    const double psnr = splat_loss(maps, splats).psnr;
    EXPECT_GT(psnr, before);
    before = psnr;
    const double spz = splat_loss(maps, as_stored(splats, SplatFormat::kSpz)).psnr;
    EXPECT_LT(spz, psnr + 0.1);
    // Coefficients rounded to 1/32: 255^2 (1/32)^2 / 12 / (4 pi) each, 3.4 for the 8 of degree 2,
    // which adds 0.9 dB to a squared error of 15, and some more where directions weigh unevenly.
    EXPECT_GT(spz, degree == 3 ? 30 : psnr - 1.3);
  }
}

TEST(SplatTest, DiscsTurnTheirThinAxisOntoTheNormalByAQuarterTurnAtMost) {
  for (const Vec3& n :
       {Vec3{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, {0.6, 0, -0.8}, {0.48, -0.6, 0.64}}) {
    const auto [w, x, y, z] = disc_rotation({float(n[0]), float(n[1]), float(n[2])});
    EXPECT_GE(w, 0.7071f);
    const std::array<float, 3> thin{2 * (x * z + w * y), 2 * (y * z - w * x),
                                    1 - 2 * (x * x + y * y)};
    EXPECT_NEAR(std::abs(dot(thin, n)), 1, 1e-6);
  }
}

TEST(SplatTest, WhatSpzCannotHoldIsRefused) {
  SplatCloud splats = splats_of(ViewMaps(harmonic_ball(Directions::kWorld)));
  for (float& deviation : splats.deviations) deviation *= 1e-6f;
  EXPECT_EQ(splat_file(splats, SplatFormat::kSpz).error().code, Errc::kInvalidInput);
  for (float& deviation : splats.deviations) deviation *= 1e6f;
  splats.positions[0][0] = 1e8f;
  EXPECT_EQ(splat_file(splats, SplatFormat::kSpz).error().code, Errc::kInvalidInput);
}

TEST(SplatTest, AGlbHasTheLengthsThatItSaysAndIsRefusedBeyondFourGibibytes) {
  for (int degree = 0; degree <= 3; ++degree) {
    const ViewMaps maps(harmonic_ball(Directions::kWorld));
    const SplatCloud splats = splats_of(maps, {.degree = degree});
    const auto file = splat_file(splats, SplatFormat::kGlb);
    ASSERT_TRUE(file);
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, file->data() + at, 4);
      return value;
    };
    EXPECT_EQ(word(8), file->size());
    EXPECT_EQ(word(20 + word(12)), *glb_buffer_bytes(splats.size(), splats.num_harmonics()));
    EXPECT_EQ(28 + word(12) + word(20 + word(12)), file->size());
  }
  EXPECT_EQ(*glb_buffer_bytes(17'600'000, 16), 4'294'400'000u);
  EXPECT_EQ(glb_buffer_bytes(17'610'000, 16).error().code, Errc::kInvalidInput);
  EXPECT_EQ(glb_buffer_bytes(std::uint64_t{1} << 32, 1).error().code, Errc::kInvalidInput);
}

TEST(SplatTest, SettingsOutOfRangeAndNoPointsAreErrors) {
  const ViewMaps maps(harmonic_ball(Directions::kWorld));
  EXPECT_EQ(make_splats(maps, {.degree = 4}).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(make_splats(maps, {.size = NAN}).error().code, Errc::kInvalidArgument);
  LightField empty = harmonic_ball(Directions::kWorld);
  empty.positions.clear();
  empty.components.clear();
  EXPECT_EQ(make_splats(ViewMaps(empty), {}).error().code, Errc::kInvalidInput);
}

}  // namespace
}  // namespace slf::splats_test
