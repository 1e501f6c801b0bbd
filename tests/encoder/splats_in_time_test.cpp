// SPDX-License-Identifier: Apache-2.0
// Splats of frames: what no changed pixel shows stays as it was, and the rest follows photographs.
#include "encoder/train/splats_in_time.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>

#include "slf/frames.h"
#include "slf/gaussian_renderer.h"
#include "traced_scene.h"

namespace slf::splats_in_time_test {
namespace {

constexpr int kSide = 128;

Image with_noise(Image image, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 1.5);
  for (std::size_t i = 0; i < image.data.size(); ++i)
    if (image.channels == 3 || i % 4 != 3)
      image.data[i] = static_cast<std::uint8_t>(
          std::clamp(std::lround(image.data[i] + noise(random)), 0L, 255L));
  return image;
}

/// The lower rows become red where they show the object.
Image reddened(Image image, int from) {
  const Image before = image;
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t p = static_cast<std::size_t>(from * image.width);
       p < static_cast<std::size_t>(image.width * image.height); ++p)
    if (!std::equal(image.data.begin() + std::ptrdiff_t(p * channels),
                    image.data.begin() + std::ptrdiff_t(p * channels + 3), before.data.begin()))
      image.data[p * channels] = 255;
  return image;
}

class SplatsInTimeTest : public testing::Test {
 protected:
  SplatsInTimeTest() : traced_("vase", 2, 6, kSide, 2000) { traced_.capture.cloud = traced_.exact; }

  Capture frame(unsigned seed, int red_from = kSide) const {
    Capture out = traced_.capture;
    for (Image& image : out.images)
      image = with_noise(reddened(std::move(image), red_from), seed++);
    return out;
  }
  static TrainGeometrySettings quick(int threads = 0) {
    TrainGeometrySettings settings;
    settings.iterations = 300;
    settings.surfels = 800;
    settings.threads = threads;
    return settings;
  }
  static bool is_same(const Gaussians& a, const Gaussians& b) {
    return a.positions == b.positions && a.logits == b.logits && a.harmonics == b.harmonics &&
           a.log_deviations == b.log_deviations && a.rotations == b.rotations;
  }
  /// How much more red than green the lower quarter of the first camera's picture is, on the mean.
  double red_below(const Gaussians& splats) const {
    const GaussianRenderer renderer(splats, {.background = {0, 0, 0}, .threads = 1});
    const Image picture = renderer.render(traced_.capture.cameras[0]).image;
    double sum = 0;
    for (std::size_t p = 3u * kSide * kSide / 4; p < 1u * kSide * kSide; ++p)
      sum += picture.data[3 * p] - picture.data[3 * p + 1];
    return sum / (kSide * kSide / 4.0);
  }

  test::TracedScene traced_;
};

TEST_F(SplatsInTimeTest, WhatOnlyNoiseChangesStaysToTheBit) {
  SplatsInTime training(quick());
  const auto first = training.next(frame(1), traced_.cameras);
  const auto second = training.next(frame(101), traced_.cameras);
  ASSERT_TRUE(first && second);
  EXPECT_GT(first->size(), 200u);
  EXPECT_TRUE(is_same(*first, *second));
}

TEST_F(SplatsInTimeTest, WhatChangesIsTrainedAndTheRestStays) {
  SplatsInTime training(quick());
  const auto first = training.next(frame(1), traced_.cameras);
  const auto second = training.next(frame(101, 3 * kSide / 4), traced_.cameras);
  ASSERT_TRUE(first && second);
  EXPECT_GT(red_below(*second), red_below(*first) + 10);
  std::size_t kept = 0;
  for (const auto& position : first->positions)
    kept += std::find(second->positions.begin(), second->positions.end(), position) !=
            second->positions.end();
  EXPECT_GT(double(kept), 0.3 * double(first->size()));
  EXPECT_LT(double(kept), 0.95 * double(first->size()));
}

TEST_F(SplatsInTimeTest, SameForAnyNumberOfThreads) {
  std::vector<Gaussians> ends;
  for (const int threads : {1, 3}) {
    SplatsInTime training(quick(threads));
    ASSERT_TRUE(training.next(frame(1), traced_.cameras));
    const auto end = training.next(frame(101, 3 * kSide / 4), traced_.cameras);
    ASSERT_TRUE(end);
    ends.push_back(*end);
  }
  EXPECT_TRUE(is_same(ends[0], ends[1]));
}

TEST_F(SplatsInTimeTest, AnOriginOfEachFrameIsTakenIntoAccount) {
  SplatsInTime training(quick());
  const auto first = training.next(frame(1), traced_.cameras);
  Capture moved_on = frame(101);
  moved_on.origin = {2, -4, 8};  // the same world
  for (Camera& camera : moved_on.cameras) camera = moved(camera, {-2, 4, -8});
  const auto second = training.next(moved_on, traced_.cameras);
  ASSERT_TRUE(first && second);
  EXPECT_TRUE(is_same(*first, *second));
}

TEST_F(SplatsInTimeTest, PhotographsAreComparedCameraByCameraWhereverTheyAreInTheList) {
  SplatsInTime training(quick());
  const auto first = training.next(frame(1), traced_.cameras);
  Capture turned_round = frame(101);
  std::reverse(turned_round.cameras.begin(), turned_round.cameras.end());
  std::reverse(turned_round.images.begin(), turned_round.images.end());
  const auto second = training.next(turned_round, traced_.cameras);
  const std::vector<int> fewer(traced_.cameras.begin() + 1, traced_.cameras.end());
  const auto third = training.next(frame(201), fewer);  // one that shows nothing is left out
  const auto fourth = training.next(frame(301), traced_.cameras);
  ASSERT_TRUE(first && second && third && fourth);
  EXPECT_TRUE(is_same(*first, *second));
  EXPECT_TRUE(is_same(*first, *third));
  EXPECT_TRUE(is_same(*first, *fourth));
}

TEST_F(SplatsInTimeTest, EveryFrameHasItsOwnDepthsAndBackgrounds) {
  SplatsInTime training(quick());
  ASSERT_TRUE(training.next(frame(1), traced_.cameras));
  const ViewSetting before = *training.cache().views[0];
  Capture farther = frame(101);
  for (Camera& camera : farther.cameras) camera.translation[2] *= 4;
  for (Image& image : farther.images) std::fill(image.data.begin(), image.data.end(), 200);
  ASSERT_TRUE(training.next(farther, traced_.cameras));
  EXPECT_GT(training.cache().views[0]->depth, 3 * before.depth);
  EXPECT_EQ(training.cache().views[0]->background[0], 200);
}

Result<EncodedFrames, InputError> coded(const std::vector<LoadedFrame>& frames,
                                        const EncoderSettings& settings,
                                        const FrameSettings& frame_settings) {
  return encode_frames(
      frames.size(), [&](std::size_t f) { return Result<LoadedFrame, InputError>(frames[f]); },
      settings, frame_settings,
      [](std::size_t, std::span<const std::uint8_t>) { return Result<Done, InputError>(Done{}); });
}

TEST_F(SplatsInTimeTest, FramesThatTheyCannotBeTrainedOfAreRefusedByWhatIsMissing) {
  EncoderSettings splats;
  splats.surface = Surface::kSplats;
  const LoadedFrame frame{traced_.capture, traced_.cameras};
  FrameSettings second_half;
  second_half.group = 1;
  second_half.part = 1, second_half.parts = 2;
  second_half.hold_over_groups = false;
  const auto parts = coded({frame, frame}, splats, second_half);
  ASSERT_FALSE(parts);
  EXPECT_NE(parts.error().message.find("parts"), std::string::npos) << parts.error().message;
  LoadedFrame cloud = frame;
  cloud.cameras.clear();
  const auto alone = coded({cloud, cloud}, splats, {});
  ASSERT_FALSE(alone);
  EXPECT_NE(alone.error().message.find("photographs"), std::string::npos);
  LoadedFrame bare = frame;
  bare.capture.cloud = {};
  bare.capture.has_geometry = false;
  EncoderSettings given;
  given.surface = Surface::kGiven;
  const auto one_without = coded({frame, bare}, given, {});
  ASSERT_FALSE(one_without);
  EXPECT_NE(one_without.error().message.find("place 1 has no point cloud"), std::string::npos)
      << one_without.error().message;
}

}  // namespace
}  // namespace slf::splats_in_time_test
