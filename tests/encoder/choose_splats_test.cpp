// SPDX-License-Identifier: Apache-2.0
// Splats in place of a surface, where nobody asked for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/surface_points.h"
#include "encoder/choose_surface.h"
#include "encoder/coding_parameters.h"
#include "encoder/compare_splats.h"
#include "encoder/encode_splats.h"
#include "encoder/fit_capture.h"
#include "encoder/judge_surface.h"
#include "encoder/refine/held_out.h"
#include "encoder/trial_file.h"
#include "lightfield/splats/splat_axes.h"
#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/evaluate.h"
#include "slf/gaussian_renderer.h"
#include "traced_scene.h"

namespace slf::choose_splats_test {
namespace {

TEST(EncodeSplats, TranslucentThingsAreCodedAsSplatsAndNoSurfaceIsTrainedOfThem) {
  const test::TracedScene traced("vase", 5, 10, 112, 6000);
  Gaussians smoke;
  Capture capture = traced.capture;
  capture.cloud.positions = traced.exact.positions;
  for (std::size_t p = 0; p < traced.exact.positions.size(); p += 120) {
    const Float3 at = traced.exact.positions[p];
    const auto size = std::log(20 * float(traced.step));
    const auto shade = [&](std::size_t k) { return float((p * (k + 3)) % 17) / 6 - 1.4f; };
    smoke.positions.push_back(at);
    smoke.log_deviations.push_back({size, size, size});
    smoke.rotations.push_back({1, 0, 0, 0});
    smoke.logits.push_back(-1.5f);
    for (std::size_t k = 0; k < 3; ++k) smoke.harmonics.push_back(shade(k));
  }
  const GaussianRenderer renderer(smoke, {.background = {0, 0, 0}});
  for (std::size_t i = 0; i < capture.images.size(); ++i)
    capture.images[i] = renderer.render(capture.cameras[i]).image;
  const auto coded = encode(capture, traced.cameras, {});
  ASSERT_TRUE(coded) << coded.error().message;
  const SurfaceReport& report = coded->surface;
  EXPECT_EQ(report.kept, Surface::kSplats);
  EXPECT_GT(report.as_splats.psnr, report.before_psnr + 6);
  EXPECT_EQ(report.trained_psnr, 0);
  EXPECT_TRUE(has_gaussians(decode(coded->stream)->header));
  EncoderSettings settings;
  EXPECT_TRUE(may_be_splats(settings));
  settings.q = 16;
  EXPECT_FALSE(may_be_splats(settings)) << "a step of a surface";
  settings.q = EncoderSettings{}.q;
  settings.target_bytes = 100'000;
  EXPECT_TRUE(may_be_splats(settings));
  settings = {};
  settings.target_psnr = 30;
  EXPECT_FALSE(may_be_splats(settings));
}

TEST(EncodeSplats, ThatAreFarAboveThePointsShowTheirSurfaceWhereverTheOriginIs) {
  const test::TracedScene traced("vase", 5, 10, 112, 6000);
  Capture capture = traced.capture;
  capture.origin = {500'000, -20, 4'000'000};
  SplatTrial tried;
  tried.file.psnr = 40;
  tried.splats.degree = 0;
  const auto wide = float(std::log(2 * traced.step)), flat = float(std::log(0.1 * traced.step));
  for (std::size_t p = 0; p < traced.exact.positions.size(); ++p) {
    tried.splats.positions.push_back(traced.exact.positions[p]);
    tried.splats.log_deviations.push_back({wide, wide, flat});
    tried.splats.rotations.push_back(disc_rotation(traced.exact.normals[p]));
    tried.splats.logits.push_back(4);
    tried.splats.harmonics.insert(tried.splats.harmonics.end(), 3, 0.5f);
  }
  TrainingCache cache;
  SurfaceReport report;
  report.as_splats = tried.file;
  cache.tried = std::move(tried);
  EncoderSettings settings;
  settings.check_cameras = false;
  const Progress none;
  const auto beyond =
      splats_are_beyond({capture, traced.cameras, settings, report, none, cache, true},
                        split_for_mending(traced.cameras), {.psnr = 20});
  ASSERT_TRUE(beyond) << beyond.error().message;
  EXPECT_TRUE(*beyond);
}

TEST(EncodeSplats, TrialFilesHaveTheBytesOfATarget) {
  const test::TracedScene traced("die", 4, 8, 56, 4000);
  Capture capture = traced.capture;
  capture.cloud = traced.exact;
  EncoderSettings settings = settings_of(Preset::kDefault, 4);
  settings.target_bytes = 9000;
  const CameraParts parts = split_for_mending(traced.cameras);
  const auto cloud = voxelise_capture(capture, traced.cameras, settings);
  ASSERT_TRUE(cloud) << cloud.error().message;
  const auto surface = try_surface(capture, parts.matched, parts.held_out, *cloud, settings, {});
  ASSERT_TRUE(surface) << surface.error().message;
  EXPECT_NEAR(double(surface->bytes), 9000, 300);
  TrainingCache cache;
  const auto splats = glance_at_splats(
      {capture, StartId::kPoints, parts.matched, parts.held_out, settings, {}, cache});
  ASSERT_TRUE(splats) << splats.error().message;
  EXPECT_LE(splats->bytes, 9000u);
  EXPECT_GT(splats->bytes, 8900u);
}

TEST(EncodeSplats, WinBySoMuchAtNoMoreBytes) {
  SurfaceReport report;
  report.before_psnr = 25;
  report.trained_psnr = 27;
  report.as_splats.psnr = 30.6;
  report.as_splats.bytes = 50'000;
  EXPECT_TRUE(splats_win(report, 100'000));
  EXPECT_FALSE(splats_win(report, 80'000)) << "a surface is smaller";
  report.as_splats.psnr = 30.4;
  EXPECT_FALSE(splats_win(report, 100'000)) << "the surface's fit will gain that";
  report.trained_psnr = 24;
  EXPECT_TRUE(splats_win(report, 100'000));
}

/// What is chosen where points lie where they should.
SurfaceReport chosen_from_exact(const test::TracedScene& traced) {
  Capture capture = traced.capture;
  capture.cloud = traced.exact;
  SurfaceReport report;
  const auto cloud = choose_surface(capture, traced.cameras, settings_of(Preset::kDefault, 4),
                                    StartId::kPoints, report, {}, true);
  EXPECT_TRUE(cloud) << (cloud ? "" : cloud.error().message);
  EXPECT_EQ(report.kept == Surface::kSplats, cloud && cloud->positions.empty());
  return report;
}

TEST(EncodeSplats, ExactPointsThatAFitDrawsWellStay) {
  EXPECT_EQ(chosen_from_exact({"can", 4, 7, 56, 3000}).kept, Surface::kGiven);
}

TEST(EncodeSplats, ExactPointsThatLetLightThroughAreComparedByFilesOfBoth) {
  const SurfaceReport report = chosen_from_exact({"die", 4, 10, 72, 5000});
  ASSERT_GT(report.as_splats.bytes, 0u);
  ASSERT_GT(report.as_surface.bytes, 0u);
  const double more = worth_of(report.as_splats) - worth_of(report.as_surface);
  EXPECT_EQ(report.kept == Surface::kSplats, more > -0.5) << more;
}

/// A few photographs and points, and a second of training.
class QuickSplats : public testing::Test {
 protected:
  void SetUp() override {
    capture_.cloud = traced_.exact;
    settings_.surface = Surface::kSplats;
    settings_.surface_seconds = 1;
  }

  const test::TracedScene traced_{"vase", 3, 6, 48, 3000};
  Capture capture_ = traced_.capture;
  EncoderSettings settings_;
};

TEST_F(QuickSplats, HaveTheBytesThatWereAskedFor) {
  settings_.target_bytes = 9100;
  const auto coded = encode(capture_, traced_.cameras, settings_);
  ASSERT_TRUE(coded) << coded.error().message;
  EXPECT_LE(coded->stream.size(), 9100u);
  EXPECT_GE(coded->stream.size(), 9000u);
  EXPECT_LE(coded->points, 500u) << "so few photographs teach no more";
  EXPECT_GT(coded->points, 200u);
}

TEST_F(QuickSplats, AreNoMoreThanWereAskedFor) {
  settings_.splats = 300;
  const auto coded = encode(capture_, traced_.cameras, settings_);
  ASSERT_TRUE(coded) << coded.error().message;
  EXPECT_LE(coded->points, 300u);
  EXPECT_TRUE(coded->surface.more_splats.empty()) << "a number that is given is not sought";
}

TEST(EncodeSplats, CountRateUnlessSettingsSayOtherwise) {
  const EncoderSettings plain;
  EXPECT_EQ(coding_parameters(plain).rdo, 0) << "of surfaces and of splats of others";
  const EncoderSettings splats = coding_of_splats(plain);
  EXPECT_EQ(splats.rdo, 1);
  EXPECT_EQ(splats.q, kTrainedGaussianQ);
  EncoderSettings given;
  given.rdo = 0;
  given.q = 9;
  EXPECT_EQ(coding_of_splats(given).rdo, 0);
  EXPECT_EQ(coding_of_splats(given).q, 9);
}

TEST(EncodeSplats, AreAsManyAsAreWorthTheirBytesToPhotographsThatTrialsHaveNotSeen) {
  const test::TracedScene traced("can", 3, 8, 64, 3000);
  Capture capture = traced.capture;
  capture.cloud = traced.exact;
  EncoderSettings settings;
  settings.surface = Surface::kSplats;
  const auto coded = encode(capture, traced.cameras, settings);
  ASSERT_TRUE(coded) << coded.error().message;
  const SurfaceReport& report = coded->surface;
  ASSERT_GT(report.as_splats.bytes, 0u);
  ASSERT_FALSE(report.more_splats.empty());
  TrialFile best = report.as_splats;
  std::size_t most = 4000;
  for (std::size_t t = 0; t < report.more_splats.size(); ++t) {
    const TrialFile& trial = report.more_splats[t];
    const std::size_t more = best.splats * 7 / 4;
    EXPECT_LE(trial.splats, more) << t;
    const bool pays = worth_of(trial) >= worth_of(best) + 0.1;
    EXPECT_TRUE(pays || t + 1 == report.more_splats.size()) << "nothing is tried after a loss";
    if (!pays) break;
    EXPECT_TRUE(trial.splats > more / 2 || t + 1 == report.more_splats.size())
        << "photographs teach no more";
    best = trial;
    most = more;
  }
  EXPECT_LE(coded->points, most);
}

TEST_F(QuickSplats, HaveThePsnrOfPhotographsThatWasAskedFor) {
  const auto psnr_of = [&](const Encoded& coded) {
    const auto shown = gaussians_of(*decode(coded.stream));
    const GaussianRenderer renderer(*shown, {.background = {0, 0, 0}});
    const auto draw = [&](const Camera& camera) { return renderer.render(camera); };
    return evaluate_pictures(draw, capture_, traced_.cameras, {})->image.psnr;
  };
  settings_.target_psnr = 17;
  const auto coded = encode(capture_, traced_.cameras, settings_);
  ASSERT_TRUE(coded) << coded.error().message;
  // With so few splats PSNR jumps where the step changes by a little: then there is a warning.
  const double psnr = psnr_of(*coded);
  EXPECT_EQ(coded->warnings.empty(), psnr >= 17 && psnr <= 17.05) << psnr;
  EXPECT_NEAR(psnr, 17, 1);
  settings_.target_psnr = 90;
  const auto most = encode(capture_, traced_.cameras, settings_);
  ASSERT_TRUE(most) << most.error().message;
  ASSERT_EQ(most->warnings.size(), 1u);
  EXPECT_NE(most->warnings[0].find("no step gives 90.00 dB"), std::string::npos);
  EXPECT_GT(most->stream.size(), coded->stream.size());
}

TEST(TrialFile, CountsTheObjectAsMuchAsAllPixelsWhereItIsKnown) {
  const TrialFile all{30, 0.95, 40'000}, object{26, 0.9, 40'000};
  const TrialFile both{30, 0.95, 40'000, 26, 0.9};
  EXPECT_NEAR(worth_of(both), (worth_of(all) + worth_of(object)) / 2, 1e-9);
}

TEST(TrialFile, IsWorthWhatPicturesShowLessWhatItTakes) {
  const TrialFile file{26, 0.9, 40'000};
  EXPECT_NEAR(worth_of(file) - worth_of({26, 0.9, 80'000}), 0.5, 1e-9);
  EXPECT_NEAR(worth_of({27, 0.9, 40'000}) - worth_of(file), 0.5, 1e-9);
  EXPECT_NEAR(worth_of({26, 0.99, 40'000}) - worth_of(file), 5, 1e-9) << "a tenth of the error";
  EXPECT_GT(worth_of({25.5, 0.907, 26'900}), worth_of({26.2, 0.839, 16'200})) << "die: splats";
  EXPECT_LT(worth_of({24.8, 0.922, 103'800}), worth_of({27.9, 0.936, 86'300})) << "can: surface";
  EXPECT_TRUE(std::isfinite(worth_of({50, 1, 1})));
}

}  // namespace
}  // namespace slf::choose_splats_test
