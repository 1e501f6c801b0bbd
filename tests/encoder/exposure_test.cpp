// SPDX-License-Identifier: Apache-2.0
// Photographs of different exposure and white balance are made to agree before anything else.
#include "slf/exposure.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "capture/upright.h"
#include "encoder/fit/match_exposure.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/evaluate.h"
#include "tests/capture/capture_support.h"
#include "tools/synth/exposure_drift.h"
#include "traced_scene.h"

namespace slf::exposure_test {
namespace {

constexpr double kDrift = 0.15;

/// A can in 48 small photographs, of one exposure and of many.
class ExposureTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const test::TracedScene traced("can", 4, 12, 96, 6000);
    locked_ = traced.capture;
    locked_.cloud = traced.exact;
    for (const int camera : traced.cameras)
      (camera % 4 == 3 ? held_out_ : input_).push_back(camera);
    drifting_ = locked_;
    for (std::size_t i = 0; i < drifting_.images.size(); ++i)
      synth::expose(drifting_.images[i], synth::drawn_gains(1, i, kDrift));
  }

  static EncoderSettings settings(MatchExposure mode) {
    EncoderSettings s = settings_of(Preset::kDefault, 3);
    s.surface = Surface::kGiven;
    s.match_exposure = mode;
    s.q = 8;
    return s;
  }

  static inline Capture locked_, drifting_;
  static inline std::vector<int> input_, held_out_;
};

TEST_F(ExposureTest, GainsThatWereDrawnAreFoundUpToTheirMean) {
  const auto report = match_exposure(drifting_, input_, MatchExposure::kAuto, 0);
  ASSERT_TRUE(report) << report.error().message;
  ASSERT_EQ(report->gains.size(), drifting_.cameras.size());
  for (std::size_t k = 0; k < 3; ++k) {
    double mean = 0, found_mean = 0, squares = 0, drawn_squares = 0;
    const auto count = double(input_.size());
    const auto drawn = [&](int i) {
      return -std::log(synth::drawn_gains(1, std::size_t(i), kDrift)[k]);
    };
    const auto found = [&](int i) { return std::log(double(report->gains[std::size_t(i)][k])); };
    for (const int i : input_) mean += drawn(i) / count, found_mean += found(i) / count;
    EXPECT_NEAR(found_mean, 0, 1e-5) << "the capture's mean look stays";
    for (const int i : input_) {
      squares += std::pow(found(i) - (drawn(i) - mean), 2) / count;
      drawn_squares += std::pow(drawn(i) - mean, 2) / count;
    }
    EXPECT_GT(std::sqrt(drawn_squares), 0.06);
    EXPECT_LT(std::sqrt(squares), 0.025) << "channel " << k;
  }
  for (const int i : held_out_)
    EXPECT_EQ(report->gains[std::size_t(i)], (std::array<float, 3>{1, 1, 1}));
}

TEST_F(ExposureTest, PhotographsOfOneExposureStayAsTheyAreAndSoDoesTheFile) {
  const auto report = match_exposure(locked_, input_, MatchExposure::kAuto, 0);
  ASSERT_TRUE(report);
  EXPECT_TRUE(report->gains.empty());
  EXPECT_GT(report->pairs, 20u);
  const auto matched = encode(locked_, input_, settings(MatchExposure::kAuto)),
             as_given = encode(locked_, input_, settings(MatchExposure::kOff));
  ASSERT_TRUE(matched && as_given);
  EXPECT_EQ(matched->stream, as_given->stream);
}

TEST_F(ExposureTest, HeldOutPicturesAreNearerAndFilesSmaller) {
  EvaluateSettings judging;
  judging.match_exposure = true;
  double psnr[2] = {};
  std::size_t bytes[2] = {};
  for (const MatchExposure mode : {MatchExposure::kOff, MatchExposure::kAuto}) {
    const auto encoded = encode(drifting_, input_, settings(mode));
    ASSERT_TRUE(encoded) << encoded.error().message;
    const bool matched = mode == MatchExposure::kAuto;
    EXPECT_EQ(encoded->exposure.gains.empty(), !matched);
    const auto field = decode(encoded->stream);
    ASSERT_TRUE(field);
    const auto quality = evaluate(ViewMaps(*field), drifting_, held_out_, judging);
    ASSERT_TRUE(quality);
    psnr[matched] = quality->image.psnr;
    bytes[matched] = encoded->stream.size();
  }
  EXPECT_GT(psnr[1], psnr[0] + 0.2) << psnr[0] << " dB, " << psnr[1] << " dB";
  EXPECT_LT(bytes[1], bytes[0]);
}

TEST_F(ExposureTest, TheSameForAnyNumberOfThreads) {
  const auto one = match_exposure(drifting_, input_, MatchExposure::kOn, 1),
             three = match_exposure(drifting_, input_, MatchExposure::kOn, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->gains, three->gains);
}

TEST_F(ExposureTest, WithoutPointsThatAnyoneSeesPhotographsStay) {
  Capture far = drifting_;
  for (auto& position : far.cloud.positions) position[0] += 1000;
  const auto report = match_exposure(far, input_, MatchExposure::kOn, 0);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(report->gains.empty());
  far.cloud = {};
  EXPECT_TRUE(match_exposure(far, input_, MatchExposure::kOn, 0)->gains.empty());
}

// As phones store them.
TEST_F(ExposureTest, PhotographsOnTheirSideAreTurnedBeforeTheyAreCompared) {
  const test::TemporaryDirectory directory;
  Capture files = drifting_;
  files.images.clear();
  files.orientation.assign(files.cameras.size(), 6);
  for (std::size_t i = 0; i < drifting_.images.size(); ++i) {
    files.image_files.push_back(directory / (std::to_string(i) + ".png"));
    ASSERT_TRUE(write_png(files.image_files[i], upright(drifting_.images[i], 8)));
  }
  const auto stored = match_exposure(files, input_, MatchExposure::kOn, 0),
             seen = match_exposure(drifting_, input_, MatchExposure::kOn, 0);
  ASSERT_TRUE(stored) << stored.error().message;
  EXPECT_FALSE(seen->gains.empty());
  EXPECT_EQ(stored->gains, seen->gains);
}

TEST_F(ExposureTest, ARenderingOfAnotherExposureIsJudgedByItsPattern) {
  const auto encoded = encode(locked_, input_, settings(MatchExposure::kOff));
  ASSERT_TRUE(encoded);
  const auto field = decode(encoded->stream);
  ASSERT_TRUE(field);
  const ViewMaps maps(*field);
  EvaluateSettings judging;
  const double raw = evaluate(maps, drifting_, held_out_, judging)->image.psnr,
               locked = evaluate(maps, locked_, held_out_, judging)->image.psnr;
  judging.match_exposure = true;
  const double matched = evaluate(maps, drifting_, held_out_, judging)->image.psnr;
  EXPECT_LT(raw, locked - 1);
  EXPECT_NEAR(matched, locked, 1);
}

TEST(ExposureGains, GainsOfPairsThatAgreeAreExactAndOneThatDoesNotIsLeftOut) {
  const std::vector<double> logs = {0.2, -0.1, 0.05, -0.25, 0.1, 0.15, -0.15};
  std::vector<ExposurePair> pairs;
  for (std::uint32_t a = 0; a < 7; ++a)
    for (std::uint32_t b = a + 1; b < 7; ++b)
      pairs.push_back({a, b, {logs[b] - logs[a], 0, logs[a] - logs[b]}, 1});
  pairs[3].log_ratio = {1, 1, 1};
  const ExposureReport report = exposure_gains(pairs, 8);
  ASSERT_EQ(report.gains.size(), 8u);
  for (std::size_t c = 0; c < 7; ++c) {
    EXPECT_NEAR(std::log(report.gains[c][0]), -logs[c], 0.01) << c;
    EXPECT_NEAR(std::log(report.gains[c][1]), 0, 0.01) << c;
    EXPECT_NEAR(std::log(report.gains[c][2]), logs[c], 0.01) << c;
  }
  EXPECT_EQ(report.gains[7], (std::array<float, 3>{1, 1, 1}));
  EXPECT_TRUE(gains_pay(report));
}

TEST(ExposureGains, DifferencesThatNoGainsExplainDoNotPay) {
  std::vector<ExposurePair> pairs;  // around a triangle each is brighter than the one before
  for (const auto& [a, b, log] : {std::tuple{0u, 1u, 0.2}, {1u, 2u, 0.2}, {0u, 2u, -0.2}})
    pairs.push_back({a, b, {log, log, log}, 1});
  EXPECT_FALSE(gains_pay(exposure_gains(pairs, 3)));
  EXPECT_TRUE(exposure_gains({}, 3).gains.empty());
}

TEST(ExposureGains, FewPairsAreExplainedByAnythingAndDoNotPay) {
  std::vector<ExposurePair> ring;  // two pairs a photograph
  for (std::uint32_t c = 0; c < 6; ++c)
    for (std::uint32_t apart : {1u, 2u})
      if (c + apart < 6) ring.push_back({c, c + apart, {0.1 * apart, 0.1 * apart, 0}, 1});
  const ExposureReport report = exposure_gains(ring, 6);
  EXPECT_GT(report.differ, 0.04);
  EXPECT_LT(report.differ_matched, 0.5 * report.differ);
  EXPECT_FALSE(gains_pay(report));
}

TEST(LoadImage, MultipliesByGainsRoundsAndClipsAndLeavesAlpha) {
  Capture capture;
  capture.cameras.resize(2);
  for (Camera& camera : capture.cameras) camera.width = camera.height = 1;
  capture.images = {{1, 1, 4, {100, 200, 3, 77}}, {1, 1, 3, {10, 20, 30}}};
  capture.gains = {{1.5f, 1.5f, 0.5f}};
  EXPECT_EQ(load_image(capture, 0)->data, (std::vector<std::uint8_t>{150, 255, 2, 77}));
  EXPECT_EQ(load_image(capture, 1)->data, capture.images[1].data);
}

}  // namespace
}  // namespace slf::exposure_test
