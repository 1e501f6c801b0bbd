// SPDX-License-Identifier: Apache-2.0
// Splats of a georeferenced world, far from 0: nothing of them is lost to floats.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <random>

#include "base/vec3.h"
#include "slf/crop_gaussians.h"
#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/gaussian_files.h"
#include "slf/gaussian_frames.h"
#include "slf/gaussian_renderer.h"

namespace slf::far_gaussians_test {
namespace {

const Vec3 kFar = {500000, 4000000, 100};

Gaussians ball(std::size_t count = 300) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  Gaussians out;
  out.up = UpAxis::kPlusZ;
  for (std::size_t p = 0; p < count; ++p) {
    out.positions.push_back({normal(random), normal(random), normal(random)});
    out.log_deviations.push_back({-3, -2.5f, -3.5f});
    out.rotations.push_back({1, 0, 0, 0});
    out.logits.push_back(2);
    for (int c = 0; c < 3; ++c) out.harmonics.push_back(normal(random));
  }
  return out;
}

/// The places in the world, in order.
std::vector<Vec3> places(const Gaussians& splats) {
  std::vector<Vec3> out;
  for (const auto& at : splats.positions) out.push_back(plus(splats.origin, to_double(at)));
  std::sort(out.begin(), out.end());
  return out;
}

/// The least distance from each of `some` to any of `others`, the largest.
double distance(const Gaussians& some, const Gaussians& others) {
  double worst = 0;
  for (const Vec3& a : places(some)) {
    double least = INFINITY;
    for (const Vec3& b : places(others)) {
      const Vec3 d = minus(a, b);
      least = std::min(least, dot(d, d));
    }
    worst = std::max(worst, std::sqrt(least));
  }
  return worst;
}

Gaussians decoded(const std::vector<std::uint8_t>& stream) {
  const auto field = decode(stream);
  EXPECT_TRUE(field);
  return *gaussians_of(*field);
}

TEST(FarGaussians, AreCodedAndDrawnAsThoseAtTheOrigin) {
  Gaussians far = ball();
  far.origin = kFar;
  const auto near_file = encode_gaussians(ball(), {}), far_file = encode_gaussians(far, {});
  ASSERT_TRUE(near_file && far_file);
  const Gaussians near_back = decoded(near_file->stream), far_back = decoded(far_file->stream);
  EXPECT_NE(far_back.origin, (Vec3{0, 0, 0}));
  EXPECT_EQ(near_back.origin, (Vec3{0, 0, 0}));
  EXPECT_LT(distance(far, far_back), 2 * far_file->grid.step);
  const GaussianRenderer near_renderer(near_back), far_renderer(far_back);
  const Camera camera = near_renderer.orbit(0.2, 20, 160, 120);
  const Camera moved_camera = far_renderer.orbit(0.2, 20, 160, 120);
  const Vec3 apart = minus(minus(moved_camera.centre(), camera.centre()), kFar);
  EXPECT_LT(std::sqrt(dot(apart, apart)), 1e-3);
  const auto a = near_renderer.render(camera).image.data;
  const auto b = far_renderer.render(moved(camera, kFar)).image.data;
  double squares = 0;
  for (std::size_t i = 0; i < a.size(); ++i) squares += (a[i] - b[i]) * (a[i] - b[i]);
  EXPECT_LT(squares / double(a.size()), 0.1);
}

/// What a program writes that has doubles.
std::vector<std::uint8_t> ply_of_doubles(const Gaussians& splats) {
  std::string head = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                     std::to_string(splats.size()) + "\n";
  for (const char* axis : {"x", "y", "z"}) head += std::string("property double ") + axis + "\n";
  for (const char* name : {"f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0", "scale_1", "scale_2",
                           "rot_0", "rot_1", "rot_2", "rot_3"})
    head += std::string("property float ") + name + "\n";
  head += "end_header\n";
  std::vector<std::uint8_t> out(head.begin(), head.end());
  const auto put = [&](const auto& value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    out.insert(out.end(), bytes, bytes + sizeof value);
  };
  for (std::size_t p = 0; p < splats.size(); ++p) {
    for (const double x : plus(splats.origin, to_double(splats.positions[p]))) put(x);
    for (std::size_t c = 0; c < 3; ++c) put(splats.harmonics[3 * p + c]);
    put(splats.logits[p]);
    for (const float x : splats.log_deviations[p]) put(x);
    for (const float x : splats.rotations[p]) put(x);
  }
  return out;
}

TEST(FarGaussians, DoublesOfAPlyKeepTheirDigits) {
  Gaussians far = ball();
  far.origin = kFar;
  const auto file = parse_gaussians("far.ply", ply_of_doubles(far));
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_NE(file->gaussians.origin, (Vec3{0, 0, 0}));
  EXPECT_LT(distance(far, file->gaussians), 1e-5);
  const auto here = parse_gaussians("near.ply", ply_of_doubles(ball()));
  ASSERT_TRUE(here);
  EXPECT_EQ(here->gaussians.origin, (Vec3{0, 0, 0}));
}

TEST(FarGaussians, AGlbSaysWhereItsNodeStands) {
  Gaussians far = ball();
  far.origin = kFar;
  const auto bytes = gaussian_file(far, SplatFormat::kGlb);
  ASSERT_TRUE(bytes) << bytes.error().message;
  const auto back = parse_gaussians("far.glb", *bytes);
  ASSERT_TRUE(back) << back.error().message;
  // y is up in glTF: x, z, -y.
  Gaussians turned = back->gaussians;
  const auto swap = [](auto& v) { v = {v[0], -v[2], v[1]}; };
  for (auto& at : turned.positions) swap(at);
  swap(turned.origin);
  EXPECT_LT(distance(far, turned), 1e-5);
}

TEST(FarGaussians, AreCroppedAndMovedByTheWorld) {
  Gaussians far = ball();
  far.origin = kFar;
  Gaussians half = far;
  ASSERT_TRUE(crop(half, {{kFar[0], -1e9, -1e9}, {1e9, 1e9, 1e9}}));
  EXPECT_LT(half.size(), far.size());
  for (const auto& at : half.positions) EXPECT_GE(at[0], 0);

  Gaussians there = ball();
  change_world({{1, 2, 3}, 1, kFar}, there);
  EXPECT_LT(distance(far, there), 1e-5);
  change_world({{1, 2, 3}, 1, {-kFar[0], -kFar[1], -kFar[2]}}, there);
  EXPECT_LT(distance(ball(), there), 1e-5);
  Gaussians shifted = ball();
  change_world({{1, 2, 3}, 1, {5, 0, 0}}, shifted);
  EXPECT_EQ(shifted.origin, (Vec3{0, 0, 0}));
}

TEST(FarGaussians, FramesFromDifferentOriginsAreOnOneGrid) {
  std::vector<std::uint8_t> stream;
  const auto frame = [](std::size_t f) -> Result<Gaussians, InputError> {
    Gaussians splats = ball();
    splats.origin = {kFar[0] + double(f), kFar[1], kFar[2]};
    for (auto& at : splats.positions) at[0] -= float(f);
    return splats;
  };
  const auto encoded = encode_gaussian_frames(
      3, frame, {}, {},
      [&](std::size_t, std::span<const std::uint8_t> bytes) -> Result<Done, InputError> {
        stream.insert(stream.end(), bytes.begin(), bytes.end());
        return Done{};
      });
  ASSERT_TRUE(encoded) << encoded.error().message;
  FrameDecoder decoder = *FrameDecoder::open(stream);
  ASSERT_EQ(decoder.frames().size(), 3u);
  Gaussians far = ball();
  far.origin = kFar;
  for (std::size_t f = 0; f < 3; ++f)
    EXPECT_LT(distance(far, *gaussians_of(*decoder.decode(f))), 2 * encoded->grid.step) << f;
}

TEST(CrowdedGaussians, StayInTheirCube) {
  for (const std::size_t count : {std::size_t{500}, std::size_t{4000}}) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> even(0, 1);
    Gaussians fog = ball(count);
    for (std::size_t p = 0; p < count; ++p) {
      fog.positions[p] = {even(random), even(random), even(random)};
      fog.log_deviations[p] = {2, 2, 2};  // far larger than the box
      fog.logits[p] = -4;
    }
    const auto file = encode_gaussians(fog, {});
    ASSERT_TRUE(file);
    const Gaussians back = decoded(file->stream);
    for (const Vec3& at : places(back))
      for (const double x : at) EXPECT_TRUE(x > -0.1 && x < 1.1) << count << ": " << x;
    EXPECT_LT(distance(back, fog), 0.35) << count;
  }
}

TEST(CrowdedGaussians, CopiesDoNotMakeTheGridOfAllFiner) {
  const auto bits_with = [](std::size_t copies) {
    Gaussians splats = ball(1000);
    for (std::size_t p = 0; p < copies; ++p) splats.positions[p] = splats.positions[0];
    return encode_gaussians(splats, {})->grid.bits;
  };
  EXPECT_EQ(bits_with(500), bits_with(0));
}

TEST(FarGaussians, BeyondWhatPicturesHoldAreRefused) {
  Gaussians lost = ball();
  lost.origin = {1e13, 0, 0};
  EXPECT_FALSE(encode_gaussians(lost, {}));
  EXPECT_FALSE(encode_gaussians(ball(), {}, {0, 1e13, 0}));
}

TEST(FarGaussians, ATargetIsOfPicturesFromWhereTheyAre) {
  EncoderSettings settings;
  settings.target_psnr = 35;
  const auto near_file = encode_gaussians(ball(), settings);
  const auto far_file = encode_gaussians(ball(), settings, kFar);
  ASSERT_TRUE(near_file && far_file);
  EXPECT_NEAR(near_file->q, far_file->q, 0.05 * near_file->q);
  EXPECT_TRUE(far_file->warning.empty()) << far_file->warning;
}

}  // namespace
}  // namespace slf::far_gaussians_test
