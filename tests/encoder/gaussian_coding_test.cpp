// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <set>

#include "encoder/gaussian_coding.h"
#include "encoder/gaussian_planes.h"
#include "encoder/splat_pictures.h"
#include "lightfield/symmetric3.h"
#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/given_planes.h"
#include "slf/view_map.h"

namespace slf::gaussian_coding_test {
namespace {

/// Splats on a sphere with shapes, opacities and harmonics of every size.
Gaussians some_splats(std::size_t count, int degree, unsigned seed = 5) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<float> even(0, 1);
  Gaussians out;
  out.degree = degree;
  out.up = UpAxis::kMinusY;
  for (std::size_t p = 0; p < count; ++p) {
    std::array<float, 3> at{normal(random), normal(random), normal(random)};
    const float length = std::hypot(at[0], at[1], at[2]);
    for (float& x : at) x = 3 * x / length + 10;
    out.positions.push_back(at);
    out.log_deviations.push_back({-3 + normal(random), -3 + normal(random), -5 + normal(random)});
    std::array<float, 4> q{normal(random), normal(random), normal(random), normal(random)};
    const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (float& x : q) x /= norm;
    out.rotations.push_back(q);
    out.logits.push_back(8 * even(random) - 3);
    for (std::size_t k = 0; k < out.num_harmonics(); ++k)
      for (int c = 0; c < 3; ++c) out.harmonics.push_back((k == 0 ? 1.0f : 0.2f) * normal(random));
  }
  return out;
}

Symmetric3 logarithm(const Gaussians& splats, std::size_t p) {
  Axes3 axes{rotation_of(splats.rotations[p]), {}};
  for (std::size_t i = 0; i < 3; ++i) axes.value[i] = double{splats.log_deviations[p][i]};
  return matrix_of(axes);
}

/// The one of `splats` that is nearest to one of `others`.
std::size_t nearest(const Gaussians& splats, const std::array<float, 3>& at) {
  std::size_t best = 0;
  float least = INFINITY;
  for (std::size_t p = 0; p < splats.size(); ++p) {
    float square = 0;
    for (std::size_t k = 0; k < 3; ++k)
      square += (splats.positions[p][k] - at[k]) * (splats.positions[p][k] - at[k]);
    if (square < least) least = square, best = p;
  }
  return best;
}

TEST(Spec_6_8_Gaussians, ComeBackAsTheyWereButForRounding) {
  for (const int degree : {0, 1, 2, 3, 4}) {
    const Gaussians given = some_splats(200, degree);
    const auto field = light_field_of(given, 1e-4, 1);
    ASSERT_TRUE(field) << field.error().message;
    const auto back = gaussians_of(*field, 2);
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->size(), given.size());
    EXPECT_EQ(back->degree, degree);
    EXPECT_EQ(back->up, UpAxis::kMinusY);
    for (std::size_t p = 0; p < back->size(); ++p) {
      const std::size_t o = nearest(given, back->positions[p]);
      for (std::size_t k = 0; k < 3; ++k)
        EXPECT_NEAR(back->positions[p][k], given.positions[o][k], 1e-4);
      EXPECT_NEAR(back->logits[p], given.logits[o], 1e-3);
      const Symmetric3 a = logarithm(*back, p), b = logarithm(given, o);
      for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(a[i], b[i], 2e-3);
      const std::size_t row = 3 * given.num_harmonics();
      for (std::size_t j = 0; j < row; ++j)
        EXPECT_NEAR(back->harmonics[p * row + j], given.harmonics[o * row + j], 1e-3);
    }
  }
}

TEST(Spec_6_8_Gaussians, ShowTheColoursOfTheirHarmonics) {
  const Gaussians given = some_splats(20, 2);
  const auto field = light_field_of(given, 1e-3, 1);
  ASSERT_TRUE(field);
  const ViewMaps maps(*field, 1);
  const auto back = gaussians_of(*field, 1);
  ASSERT_TRUE(back);
  const double y00 = 0.28209479177387814, y1 = 0.4886025119029199;
  for (std::size_t p = 0; p < maps.num_points(); ++p) {
    // Up to degree 1, with the others set to 0: along +z from the point to the eye.
    LightField flat = *field;
    const std::size_t row = 3 * static_cast<std::size_t>(flat.header.num_functions);
    for (std::size_t j = 3 * 4; j < 3 * 9; ++j) flat.components[p * row + j] = 0;
    const auto seen = ViewMaps(flat, 1).radiance_unclamped(p, 0, 1);
    const float* h = &back->harmonics[p * 27];
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(double{seen[c]}, 255 * (0.5 + y00 * double{h[c]} - y1 * double{h[6 + c]}), 0.5);
  }
}

TEST(Spec_6_8_Gaussians, ThatShareAPlaceAllStay) {
  Gaussians given = some_splats(300, 0);
  for (std::size_t p = 0; p < 280; ++p) given.positions[p] = given.positions[0];
  const auto field = light_field_of(given, 0.05, 1);
  ASSERT_TRUE(field);
  EXPECT_EQ(std::set<Voxel>(field->positions.begin(), field->positions.end()).size(), 300u);
  EXPECT_TRUE(gaussians_of(*decode(*pack(*field))));
  for (auto& at : given.positions) at = {1, 2, 3};
  const auto one_place = light_field_of(given, 0.05, 1);
  ASSERT_TRUE(one_place);
  EXPECT_EQ(one_place->num_points(), 300u);
}

TEST(Spec_6_8_Shape, EigenvectorsAreARotationWhateverTheMatrix) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 300; ++i) {
    Symmetric3 m;
    for (double& x : m) x = i % 5 == 0 ? 0 : 40 * normal(random);
    if (i % 3 == 0) m[1] = m[0], m[3] = 0;
    const Axes3 axes = eigen_axes(m);
    const Symmetric3 again = matrix_of(axes);
    for (std::size_t e = 0; e < 6; ++e) EXPECT_NEAR(again[e], m[e], 1e-9);
    const auto& a = axes.axis;
    const double determinant = a[0][0] * (a[1][1] * a[2][2] - a[1][2] * a[2][1]) -
                               a[0][1] * (a[1][0] * a[2][2] - a[1][2] * a[2][0]) +
                               a[0][2] * (a[1][0] * a[2][1] - a[1][1] * a[2][0]);
    EXPECT_NEAR(determinant, 1, 1e-12);
    const Matrix3x3 turned = rotation_of(quaternion_of(axes.axis));
    for (std::size_t r = 0; r < 3; ++r)
      for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(turned[r][c], a[r][c], 1e-6);
    const Symmetric3 coded = from_shape_values(shape_values(m));
    for (std::size_t e = 0; e < 6; ++e) EXPECT_NEAR(coded[e], m[e], 1e-12);
  }
}

TEST(Spec_E_6_Gaussians, AreBlurredByTheirVoxelWhereLevelsAreLeftOut) {
  const auto encoded = encode_gaussians(some_splats(300, 1), {});
  ASSERT_TRUE(encoded) << encoded.error().message;
  for (const int left_out : {0, 1, 4}) {
    DecodeOptions options;
    options.levels = encoded->grid.bits - left_out;
    const auto field = decode(encoded->stream, options);
    ASSERT_TRUE(field);
    EXPECT_EQ(field->header.levels_left_out, left_out);
    LightField unblurred = *field;
    unblurred.header.levels_left_out = 0;
    const Gaussians splats = *gaussians_of(*field), before = *gaussians_of(unblurred);
    const double step = field->header.grid.step, blur = left_out == 0 ? 0 : step * step / 24;
    for (std::size_t p = 0; p < splats.size(); ++p)
      for (std::size_t i = 0; i < 3; ++i) {
        const double variance = std::exp(2.0 * double{before.log_deviations[p][i]}) + blur;
        EXPECT_NEAR(splats.log_deviations[p][i], 0.5 * std::log(variance), 1e-5);
      }
  }
}

TEST(SplatLevelEnds, AreWhereSplatsComeApart) {
  EXPECT_EQ(splat_level_ends(std::vector<Voxel>{{3, 4, 5}}, 1), (std::vector{1}));
  EXPECT_EQ(splat_level_ends(std::vector<Voxel>{{0, 0, 0}, {1023, 0, 0}}, 10),
            (std::vector{1, 10}));
  // Two clumps of eight far from each other, one of them in steps of 16 and the other of one voxel.
  std::vector<Voxel> clumps;
  for (const std::int32_t apart : {16, 1})
    for (int i = 0; i < 8; ++i) {
      const std::int32_t corner = apart == 16 ? 0 : 512;
      clumps.push_back(
          {corner + apart * (i & 1), corner + apart * (i >> 1 & 1), corner + apart * (i >> 2)});
    }
  // Nodes: 1, then 2 from level 1 on, 9 from level 6 on, 16 at level 10.
  EXPECT_EQ(splat_level_ends(clumps, 10), (std::vector{6, 10}));
}

TEST(EncodeGaussians, FilesOfACoarserQualityAreSmaller) {
  const Gaussians given = some_splats(2000, 2);
  EncoderSettings settings;
  std::size_t before = SIZE_MAX;
  for (const double q : {2.0, 8.0, 32.0}) {
    settings.q = q;
    const auto coded = encode_gaussians(given, settings);
    ASSERT_TRUE(coded) << coded.error().message;
    EXPECT_LT(coded->stream.size(), before);
    before = coded->stream.size();
    const auto field = decode(coded->stream);
    ASSERT_TRUE(field) << to_string(field.error());
    EXPECT_TRUE(has_gaussians(field->header));
    EXPECT_EQ(gaussians_of(*field)->size(), coded->splats);
  }
}

TEST(EncodeGaussians, LieWhereTheirOriginIsOrAreRefused) {
  const Gaussians given = some_splats(50, 0);
  const auto far = encode_gaussians(given, {}, {1e6, -2e6, 0.5});
  ASSERT_TRUE(far);
  const auto here = encode_gaussians(given, {});
  for (std::size_t k = 0; k < 3; ++k)
    EXPECT_NEAR(far->grid.origin[k] - here->grid.origin[k],
                k == 0   ? 1e6
                : k == 1 ? -2e6
                         : 0.5,
                1e-6);
  EXPECT_TRUE(gaussians_of(*decode(far->stream)));
  EXPECT_FALSE(encode_gaussians(given, {}, {1e200, 0, 0}));
}

TEST(EncodeGaussians, MeetTheirBytes) {
  EncoderSettings settings;
  settings.target_bytes = 20000;
  const auto coded = encode_gaussians(some_splats(2000, 1), settings);
  ASSERT_TRUE(coded) << coded.error().message;
  EXPECT_LE(coded->stream.size(), 20000u);
  EXPECT_GE(coded->stream.size(), 19000u);
  settings.target_bytes = 200;
  EXPECT_EQ(coded->warning, "");
  const auto least = encode_gaussians(some_splats(2000, 1), settings);
  ASSERT_TRUE(least) << least.error().message;
  EXPECT_EQ(least->warning,
            "no step gives 200 bytes: the nearest gives " + std::to_string(least->stream.size()));
  settings.target_bytes = 100'000'000;
  const auto most = encode_gaussians(some_splats(200, 1), settings);
  ASSERT_TRUE(most) << most.error().message;
  EXPECT_NE(most->warning, "");
}

TEST(EncodeGaussians, MeetThePsnrOfPicturesFromAround) {
  const Gaussians given = some_splats(300, 1);
  EncoderSettings settings;
  settings.threads = 2;
  std::size_t fewer = 0;
  for (const double target : {34.0, 42.0}) {
    settings.target_psnr = target;
    const auto coded = encode_gaussians(given, settings);
    ASSERT_TRUE(coded) << coded.error().message;
    const auto shown = decoded_gaussians(coded->stream, 1);
    ASSERT_TRUE(shown);
    const double psnr = SplatPictures(given, 1).psnr_of(*shown);
    EXPECT_NEAR(psnr, target, 0.5);
    EXPECT_GT(coded->stream.size(), fewer);
    fewer = coded->stream.size();
  }
  settings.target_psnr = 99.9;
  const auto nearest = encode_gaussians(given, settings);
  ASSERT_TRUE(nearest) << nearest.error().message;
  EXPECT_EQ(nearest->warning.find("no step gives 99.90 dB: the nearest gives"), 0u);
  settings.target_psnr = 101;
  EXPECT_FALSE(encode_gaussians(given, settings));
  settings.target_psnr = 34;
  settings.target_bytes = 2000;
  EXPECT_FALSE(encode_gaussians(given, settings)) << "two targets";
}

TEST(SplatPictures, PicturesOfTheSameSplatsAreTheSame) {
  const Gaussians given = some_splats(50, 1);
  EXPECT_EQ(SplatPictures(given, 2).psnr_of(given), 100);
  EXPECT_EQ(SplatPictures({}, 1).psnr_of({}), 100) << "nothing, and nothing";
  Gaussians moved = given;
  for (auto& at : moved.positions) at[0] += 0.01f;
  EXPECT_LT(SplatPictures(given, 1).psnr_of(moved), 60);
  EXPECT_EQ(SplatPictures(given, 1).psnr_of(moved), SplatPictures(given, 2).psnr_of(moved));
}

TEST(EncodeGaussians, WithoutAnythingToSeeAreRefused) {
  EXPECT_FALSE(encode_gaussians({}, {}));
  Gaussians hidden = some_splats(10, 0);
  for (float& logit : hidden.logits) logit = -9;
  const auto refused = encode_gaussians(hidden, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kInvalidInput);
  hidden.logits[3] = 1;
  const auto one = encode_gaussians(hidden, {});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->left_out, 9u);
}

TEST(EncodeGaussians, AreTheSameForAnyNumberOfThreads) {
  const Gaussians given = some_splats(5000, 3);
  EncoderSettings settings;
  settings.threads = 1;
  const auto one = encode_gaussians(given, settings);
  settings.threads = 3;
  EXPECT_EQ(encode_gaussians(given, settings)->stream, one->stream);
}

}  // namespace
}  // namespace slf::gaussian_coding_test
