// SPDX-License-Identifier: Apache-2.0
// Bits a second of a sequence: EncoderSettings::target_bitrate.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "slf/encoder.h"
#include "slf/frames.h"

namespace slf::frames_to_bitrate_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A ball that turns: points on a sphere, coloured by where they are on it, with some noise.
LoadedFrame ball(std::size_t f) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1, 1);
  LoadedFrame frame;
  PointCloud& cloud = frame.capture.cloud;
  const double angle = 0.05 * static_cast<double>(f);
  while (cloud.positions.size() < 700) {
    const Vec3 p = {any(random), any(random), any(random)};
    const double length = std::hypot(p[0], p[1], p[2]);
    if (length > 1 || length < 0.1) continue;
    const double x = p[0] / length, y = p[1] / length;
    cloud.positions.push_back({static_cast<float>(x * std::cos(angle) - y * std::sin(angle)),
                               static_cast<float>(x * std::sin(angle) + y * std::cos(angle)),
                               static_cast<float>(p[2] / length)});
    const double grey = 128 + 60 * std::sin(9 * x) + 40 * std::cos(7 * y) + 20 * any(random);
    const auto of = [](double v) { return static_cast<std::uint8_t>(v); };
    cloud.colours.push_back({of(grey), of(255 - grey), of(grey / 2)});
  }
  return frame;
}

class TargetBitrateTest : public testing::Test {
 protected:
  /// Coded at 25 frames a second in groups of 4.
  Result<EncodedFrames, InputError> code(std::size_t frames, const EncoderSettings& settings) {
    stream_.clear();
    return encode_frames(
        frames, [](std::size_t f) { return Result<LoadedFrame, InputError>(ball(f)); }, settings,
        {.group = 4, .rate = 25},
        [&](std::size_t, std::span<const std::uint8_t> bytes) {
          stream_.insert(stream_.end(), bytes.begin(), bytes.end());
          return Result<Done, InputError>(Done{});
        });
  }
  static EncoderSettings at(double bits_a_second) {
    EncoderSettings settings;
    settings.grid_bits = 6;
    settings.target_bitrate = bits_a_second;
    settings.threads = 1;
    return settings;
  }
  double rate(std::size_t frames) const {
    return 8 * static_cast<double>(stream_.size()) * 25 / static_cast<double>(frames);
  }
  Bytes stream_;
};

TEST_F(TargetBitrateTest, IsNotExceededAndMetWithinThreePercent) {
  constexpr std::size_t kFrames = 10;
  for (const double target : {250e3, 400e3}) {
    const auto encoded = code(kFrames, at(target));
    ASSERT_TRUE(encoded) << encoded.error().message;
    EXPECT_TRUE(encoded->warnings.empty()) << encoded->warnings.front();
    EXPECT_LE(rate(kFrames), target);
    EXPECT_GE(rate(kFrames), 0.97 * target);
    std::uint64_t sum = 0;
    for (const EncodedFrame& f : encoded->frames) sum += f.bytes;
    EXPECT_EQ(sum, stream_.size());
    const auto listed = list_frames(stream_);
    ASSERT_TRUE(listed);
    EXPECT_EQ(listed->size(), kFrames);
  }
}

TEST_F(TargetBitrateTest, GivesTheFileOfItsStep) {
  const auto encoded = code(5, at(300e3));
  ASSERT_TRUE(encoded) << encoded.error().message;
  const Bytes found = stream_;
  EncoderSettings same = at(0);
  same.q = encoded->q;
  ASSERT_TRUE(code(5, same));
  EXPECT_EQ(found, stream_);
}

TEST_F(TargetBitrateTest, SameBytesForAnyNumberOfThreads) {
  ASSERT_TRUE(code(5, at(300e3)));
  const Bytes one = stream_;
  EncoderSettings settings = at(300e3);
  settings.threads = 2;
  ASSERT_TRUE(code(5, settings));
  EXPECT_EQ(one, stream_);
}

TEST_F(TargetBitrateTest, OutOfReachGivesTheNearestAndAWarning) {
  for (const double target : {1e3, 1e9}) {  // geometry alone takes more; losslessness less
    const auto encoded = code(3, at(target));
    ASSERT_TRUE(encoded) << encoded.error().message;
    ASSERT_EQ(encoded->warnings.size(), 1u);
    EXPECT_NE(encoded->warnings[0].find("bits a second"), std::string::npos);
    EXPECT_EQ(rate(3) <= target, target > 1e6);
  }
}

TEST_F(TargetBitrateTest, IsOfFramesAlone) {
  LoadedFrame frame = ball(0);
  const auto one = encode(frame.capture, {}, at(1e6));
  ASSERT_FALSE(one);
  EXPECT_NE(one.error().message.find("target bitrate"), std::string::npos);
  EXPECT_FALSE(code(3, at(-1)));
  EXPECT_FALSE(code(3, at(std::nan(""))));
}

}  // namespace
}  // namespace slf::frames_to_bitrate_test
