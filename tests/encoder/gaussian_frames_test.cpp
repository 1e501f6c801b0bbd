// SPDX-License-Identifier: Apache-2.0
// Splats as frames in time: what is decoded is what was coded, and prediction pays. Spec 6.8, 8.12.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "encoder/gaussian_planes.h"
#include "lightfield/splats/turn_gaussians.h"
#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/gaussian_frames.h"

namespace slf::gaussian_frames_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// Splats on a ball about the origin, coloured by where they are on it.
Gaussians ball(std::size_t count, int degree = 1, unsigned seed = 5) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal;
  Gaussians out;
  out.degree = degree;
  out.up = UpAxis::kPlusZ;
  for (std::size_t p = 0; p < count; ++p) {
    std::array<float, 3> at{normal(random), normal(random), normal(random)};
    const float length = std::hypot(at[0], at[1], at[2]);
    for (float& x : at) x /= length;
    out.positions.push_back(at);
    const float size = -3 + 0.3f * normal(random);
    out.log_deviations.push_back({size, size - 0.2f, size - 2});
    std::array<float, 4> q{normal(random), normal(random), normal(random), normal(random)};
    const float norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (float& x : q) x /= norm;
    out.rotations.push_back(q);
    out.logits.push_back(3 + normal(random));
    for (std::size_t k = 0; k < out.num_harmonics(); ++k)
      for (int c = 0; c < 3; ++c)
        out.harmonics.push_back(k == 0 ? std::sin(5 * at[std::size_t(c)]) : 0.05f * normal(random));
  }
  return out;
}

Gaussians turned_about_z(Gaussians splats, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  move_gaussians(splats, {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}}, 1);
  return splats;
}

struct Coded {
  EncodedFrames report;
  Bytes stream;
};

Coded code(const std::vector<Gaussians>& frames, const FrameSettings& frame_settings = {},
           const EncoderSettings& settings = {}) {
  Coded out;
  auto encoded = encode_gaussian_frames(
      frames.size(), [&](std::size_t f) { return Result<Gaussians, InputError>(frames[f]); },
      settings, frame_settings,
      [&](std::size_t, std::span<const std::uint8_t> bytes) {
        out.stream.insert(out.stream.end(), bytes.begin(), bytes.end());
        return Result<Done, InputError>(Done{});
      });
  EXPECT_TRUE(encoded) << encoded.error().message;
  if (encoded) out.report = *std::move(encoded);
  return out;
}

std::uint64_t bytes_of(const Coded& coded, bool predicted) {
  std::uint64_t sum = 0;
  for (const EncodedFrame& f : coded.report.frames) sum += f.predicted == predicted ? f.bytes : 0;
  return sum;
}

std::vector<Gaussians> turning(std::size_t frames, double angle, std::size_t count = 1500) {
  std::vector<Gaussians> out;
  for (std::size_t f = 0; f < frames; ++f)
    out.push_back(turned_about_z(ball(count), angle * double(f)));
  return out;
}

TEST(Spec_8_12_Gaussians, FramesAreThoseOfTheStillFilesOnOneGrid) {
  const auto frames = turning(3, 0.05, 400);
  EncoderSettings settings;
  settings.q = 4;
  const Coded coded = code(frames, {.group = 8, .rate = 10}, settings);
  auto decoder = FrameDecoder::open(coded.stream);
  ASSERT_TRUE(decoder);
  ASSERT_EQ(decoder->frames().size(), 3u);
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_DOUBLE_EQ(decoder->frames()[f].time, double(f) / 10);
    EXPECT_EQ(decoder->frames()[f].predicted, f > 0);
    const auto field = decoder->decode(f);
    ASSERT_TRUE(field);
    const auto still = light_field_on(frames[f], coded.report.grid, 1);
    ASSERT_TRUE(still);
    EXPECT_EQ(field->positions, still->positions);
    const auto back = gaussians_of(*field), given = gaussians_of(*still);
    ASSERT_TRUE(back && given);
    EXPECT_EQ(back->up, UpAxis::kPlusZ);
    for (std::size_t p = 0; p < back->size(); ++p) {
      EXPECT_NEAR(back->logits[p], given->logits[p], 0.5);
      EXPECT_NEAR(back->harmonics[12 * p], given->harmonics[12 * p], 0.15);
    }
  }
}

TEST(Spec_8_12_Gaussians, ThatStandStillAreNearlyFree) {
  const Coded coded = code(std::vector<Gaussians>(4, ball(1500)));
  EXPECT_LT(bytes_of(coded, true) / 3, bytes_of(coded, false) / 20);
}

TEST(Spec_8_12_Gaussians, ThatTurnTakeFewerBytesThanWithoutPrediction) {
  const auto frames = turning(4, 0.03);
  const Coded predicted = code(frames), alone = code(frames, {.group = 1});
  EXPECT_LT(bytes_of(predicted, true) / 3, bytes_of(alone, false) / 4);
}

/// What is above the middle turns.
Gaussians half_turned(const Gaussians& whole, double angle) {
  const Gaussians all = turned_about_z(whole, angle);
  Gaussians out = whole;
  const std::size_t row = 3 * whole.num_harmonics();
  for (std::size_t p = 0; p < whole.size(); ++p) {
    if (whole.positions[p][2] < 0) continue;
    out.positions[p] = all.positions[p];
    out.rotations[p] = all.rotations[p];
    std::copy_n(&all.harmonics[p * row], row, &out.harmonics[p * row]);
  }
  return out;
}

std::vector<Gaussians> half_turning(std::size_t frames, double angle, std::size_t count) {
  std::vector<Gaussians> all;
  for (std::size_t f = 0; f < frames; ++f)
    all.push_back(half_turned(ball(count), angle * double(f)));
  return all;
}

EncoderSettings by_cells() {
  EncoderSettings settings;
  settings.reference_contexts = false;
  return settings;
}

TEST(Spec_8_12_Gaussians, WithAPartThatMovesTakeFewerBytesThanThoseThatAllMove) {
  EXPECT_LT(bytes_of(code(half_turning(3, 0.03, 3000), {}, by_cells()), true),
            bytes_of(code(turning(3, 0.03, 3000), {}, by_cells()), true) * 3 / 4);
}

TEST(Spec_8_12_7_Gaussians, ThatAreFollowedTakeTwoThirdsOfWhatTheirCellsForetell) {
  for (const auto& frames : {half_turning(3, 0.03, 1500), turning(3, 0.03, 1500)})
    EXPECT_LT(3 * bytes_of(code(frames), true), 2 * bytes_of(code(frames, {}, by_cells()), true));
}

TEST(Spec_8_12_Gaussians, OnTheFinestGridAreForetoldWithoutALattice) {
  EncoderSettings settings;
  settings.grid_bits = 21;
  const auto frames = turning(2, 0.03, 500);
  const Coded coded = code(frames, {}, settings), alone = code(frames, {.group = 1}, settings);
  EXPECT_EQ(coded.report.grid.bits, 21);
  EXPECT_LT(bytes_of(coded, true), bytes_of(alone, false) / 2);
}

TEST(Spec_8_12_Gaussians, OneFrameIsThePlainFile) {
  const Gaussians splats = ball(300);
  const Coded coded = code({splats});
  const auto plain = encode_gaussians(splats, {});
  ASSERT_TRUE(plain);
  const auto one = decode(coded.stream), other = decode(plain->stream);
  ASSERT_TRUE(one && other);
  EXPECT_EQ(one->positions, other->positions);
  EXPECT_EQ(one->components, other->components);
}

TEST(Spec_8_12_Gaussians, AreTheSameBytesForAnyNumberOfThreads) {
  const auto frames = turning(3, 0.1);
  EncoderSettings one, four;
  one.threads = 1;
  four.threads = 4;
  EXPECT_EQ(code(frames, {}, one).stream, code(frames, {}, four).stream);
}

TEST(Spec_8_12_Gaussians, PartsAreTheBytesOfTheWhole) {
  const auto frames = turning(7, 0.1, 200);
  const Bytes whole = code(frames, {.group = 2}).stream;
  Bytes joined;
  for (int part = 0; part < 3; ++part) {
    const Bytes bytes = code(frames, {.group = 2, .part = part, .parts = 3}).stream;
    joined.insert(joined.end(), bytes.begin(), bytes.end());
  }
  EXPECT_EQ(joined, whole);
}

TEST(Spec_8_12_Gaussians, MayBeNoneInAFrame) {
  Gaussians faint = ball(50);
  for (float& logit : faint.logits) logit = -9;
  const Coded coded = code({Gaussians{}, ball(200), faint, ball(200)});
  ASSERT_EQ(coded.report.frames.size(), 4u);
  EXPECT_EQ(coded.report.frames[2].left_out, 50u);
  auto decoder = FrameDecoder::open(coded.stream);
  ASSERT_TRUE(decoder);
  for (std::size_t f = 0; f < 4; ++f) {
    const auto field = decoder->decode(f);
    ASSERT_TRUE(field);
    EXPECT_EQ(field->num_points(), f % 2 == 0 ? 0u : 200u);
    EXPECT_TRUE(has_gaussians(field->header));
  }
}

TEST(Spec_8_12_Gaussians, TakeABitrate) {
  const auto frames = turning(5, 0.05, 600);
  EncoderSettings settings;
  settings.target_bitrate = 8.0 * 30 * double(code(frames).stream.size()) / 5 / 2;
  const Coded coded = code(frames, {}, settings);
  const double rate = 8.0 * 30 * double(coded.stream.size()) / 5;
  EXPECT_LE(rate, settings.target_bitrate);
  EXPECT_GE(rate, 0.9 * settings.target_bitrate);
}

TEST(Spec_8_12_Gaussians, WithOtherDegreesOrAxesAreRefusedByTheirPlace) {
  Gaussians other_up = ball(20);
  other_up.up = UpAxis::kMinusY;
  for (const Gaussians& odd : {ball(20, 2), other_up}) {
    const std::vector<Gaussians> frames = {ball(20), ball(20), odd};
    const auto planned = plan_gaussian_frames(
        3, [&](std::size_t f) { return Result<Gaussians, InputError>(frames[f]); }, {}, {});
    ASSERT_FALSE(planned);
    EXPECT_NE(planned.error().message.find("frame 2"), std::string::npos);
  }
}

TEST(Spec_8_12_Gaussians, DamageIsAnErrorOrAFrame) {
  const Bytes stream = code(turning(3, 0.05, 60)).stream;
  std::mt19937 random(3);
  for (int trial = 0; trial < 150; ++trial) {
    Bytes damaged = stream;
    if (trial % 3 == 0)
      damaged.resize(random() % damaged.size());
    else
      damaged[random() % damaged.size()] ^= std::uint8_t(1 + random() % 255);
    auto decoder = FrameDecoder::open(damaged);
    if (!decoder) continue;
    for (std::size_t f = 0; f < decoder->frames().size(); ++f) {
      const auto field = decoder->decode(f);
      if (!field || !has_gaussians(field->header)) continue;
      EXPECT_TRUE(field->num_points() == 0 || gaussians_of(*field));
    }
  }
}

}  // namespace
}  // namespace slf::gaussian_frames_test
