// SPDX-License-Identifier: Apache-2.0
// What stands still keeps its view map from frame to frame; what changes does not.
#include "encoder/measure/changed_pixels.h"
#include "encoder/still_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <tuple>

#include "traced_scene.h"

namespace slf::still_points_test {
namespace {

constexpr int kSide = 96;

Image flat(std::uint8_t grey) {
  return {kSide, kSide, 3, std::vector<std::uint8_t>(3 * kSide * kSide, grey)};
}

Image with_noise(Image image, double deviation, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, deviation);
  for (auto& value : image.data)
    value = static_cast<std::uint8_t>(std::clamp(std::lround(value + noise(random)), 0L, 255L));
  return image;
}

/// A square is brighter.
Image with_square(Image image, int by, int low = 40, int high = 52) {
  for (int y = low; y < high; ++y)
    for (int x = low; x < high; ++x)
      for (int c = 0; c < 3; ++c) {
        auto& value = image.data[static_cast<std::size_t>(3 * (y * kSide + x) + c)];
        value = static_cast<std::uint8_t>(std::clamp(value + by, 0, 255));
      }
  return image;
}

std::size_t count(const std::vector<std::uint8_t>& changed) {
  return static_cast<std::size_t>(std::accumulate(changed.begin(), changed.end(), 0));
}

TEST(ChangedPixels, AreNoneOfTheSamePhotographAndFewOfNoise) {
  EXPECT_EQ(count(changed_pixels(flat(99), flat(99))), 0u);
  for (const double deviation : {0.5, 2.0, 5.0}) {
    const Image a = with_noise(flat(99), deviation, 1), b = with_noise(flat(99), deviation, 2);
    EXPECT_LE(count(changed_pixels(a, b)), 10u) << deviation;
  }
}

TEST(ChangedPixels, AreWhereSomethingChangedUnderNoiseToo) {
  for (const int by : {6, -6}) {
    const auto changed =
        changed_pixels(with_noise(flat(99), 2, 1), with_noise(with_square(flat(99), by), 2, 2));
    EXPECT_EQ(changed[46 * kSide + 46], 1) << by;
    EXPECT_EQ(changed[10 * kSide + 10], 0) << by;
    EXPECT_LE(count(changed), 20u * 20u);
  }
}

TEST(ChangedPixels, AreWhereWhatIsClearIsNotAnyMore) {
  Image clear{kSide, kSide, 4, std::vector<std::uint8_t>(4 * kSide * kSide, 0)}, other = clear;
  for (std::size_t i = 0; i < other.data.size(); i += 4) other.data[i] = 200;  // of what is clear
  EXPECT_EQ(count(changed_pixels(clear, other)), 0u);
  other.data[4 * (46 * kSide + 46) + 3] = 255;
  EXPECT_EQ(changed_pixels(clear, other)[46 * kSide + 46], 1);
}

class StillPointsTest : public testing::Test {
 protected:
  StillPointsTest() : traced_("vase", 2, 4, kSide, 900) { traced_.capture.cloud = traced_.exact; }

  LoadedFrame frame(unsigned seed, int by = 0) const {
    LoadedFrame out{traced_.capture, traced_.cameras};
    for (Image& image : out.capture.images)
      image = with_noise(with_square(std::move(image), by, 24, 72), 1.5, seed++);
    return out;
  }

  /// Codes frames; decodes them.
  std::vector<LightField> coded(const std::vector<LoadedFrame>& frames, bool hold = true) {
    std::vector<std::uint8_t> stream;
    EncoderSettings settings;
    settings.q = 8;
    settings.surface = Surface::kGiven;  // too few points for photographs of this size
    const auto encoded = encode_frames(
        frames.size(), [&](std::size_t f) { return Result<LoadedFrame, InputError>(frames[f]); },
        settings, {.hold_still = hold},
        [&](std::size_t, std::span<const std::uint8_t> bytes) {
          stream.insert(stream.end(), bytes.begin(), bytes.end());
          return Result<Done, InputError>(Done{});
        });
    EXPECT_TRUE(encoded) << (encoded ? "" : encoded.error().message);
    held_.clear();
    bytes_.clear();
    for (const EncodedFrame& f : encoded->frames) {
      held_.push_back(double(f.held) / double(f.points));
      bytes_.push_back(f.bytes);
    }
    auto decoder = FrameDecoder::open(stream);
    EXPECT_TRUE(decoder);
    std::vector<LightField> fields;
    for (std::size_t f = 0; f < frames.size(); ++f) fields.push_back(*decoder->decode(f));
    return fields;
  }

  test::TracedScene traced_;
  std::vector<double> held_;  // [frames] share of points
  std::vector<std::uint64_t> bytes_;
};

TEST_F(StillPointsTest, KeepTheirViewMapsUnderNoise) {
  const std::vector<LoadedFrame> frames{frame(1), frame(101), frame(201)};
  coded(frames, false);
  EXPECT_EQ(held_, (std::vector<double>{0, 0, 0}));
  const auto refitted = bytes_;
  const auto fields = coded(frames);
  EXPECT_EQ(held_[0], 0);
  EXPECT_GT(held_[1], 0.7);
  EXPECT_GT(held_[2], 0.7);
  EXPECT_EQ(bytes_[0], refitted[0]);
  EXPECT_LT(double(bytes_[1]), 0.5 * double(refitted[1]));
  EXPECT_EQ(fields[1].positions, fields[0].positions);
}

TEST_F(StillPointsTest, PointsOfWhatChangesAreFittedAnew) {
  coded({frame(1), frame(101, 60)});
  EXPECT_LT(held_[1], 0.6);
  // Little by little: no step of two is a change, five of them are.
  std::vector<LoadedFrame> creeping;
  for (int f = 0; f < 6; ++f) creeping.push_back(frame(unsigned(100 * f), 2 * f));
  coded(creeping);
  EXPECT_LT(*std::min_element(held_.begin() + 1, held_.end()), 0.6);
}

TEST_F(StillPointsTest, CamerasThatMoveHoldNoPoint) {
  LoadedFrame moved_on = frame(101);
  for (Camera& camera : moved_on.capture.cameras) camera.translation[0] += 1e-3;
  coded({frame(1), moved_on});
  EXPECT_EQ(held_[1], 0);
}

TEST_F(StillPointsTest, SameForAnyNumberOfThreads) {
  const LoadedFrame first = frame(1), second = frame(101, 30);
  LightField field;
  field.header.grid.step = traced_.step;
  field.header.num_functions = 1;
  for (int i = 0; i < 900; ++i) {
    field.positions.push_back({i % 9, i / 9 % 10, i / 90});
    field.components.insert(field.components.end(), 3, i);
  }
  std::sort(field.positions.begin(), field.positions.end(), [](const Voxel& a, const Voxel& b) {
    return std::tie(a[2], a[1], a[0]) < std::tie(b[2], b[1], b[0]);
  });
  std::vector<std::size_t> held;
  for (const int threads : {1, 3}) {
    StillPoints still;
    ASSERT_TRUE(still.see(first, threads));
    LightField copy = field;
    still.hold(first, copy, threads);
    ASSERT_TRUE(still.see(second, threads));
    held.push_back(still.hold(second, copy, threads));
  }
  EXPECT_EQ(held[0], held[1]);
}

}  // namespace
}  // namespace slf::still_points_test
