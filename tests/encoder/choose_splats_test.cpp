// SPDX-License-Identifier: Apache-2.0
// Splats in place of a surface, where nobody asked for them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/surface_points.h"
#include "encoder/encode_splats.h"
#include "slf/decoder.h"
#include "slf/gaussian_renderer.h"
#include "traced_scene.h"

namespace slf::choose_splats_test {
namespace {

TEST(EncodeSplats, TranslucentThingsAreCodedAsSplatsWithoutBeingAsked) {
  const test::TracedScene traced("vase", 5, 10, 112, 6000);
  Gaussians smoke;
  Capture capture = traced.capture;
  capture.cloud = {};
  for (std::size_t p = 0; p < traced.exact.positions.size(); p += 120) {
    const Float3 at = traced.exact.positions[p];
    const auto size = std::log(20 * float(traced.step));
    const auto shade = [&](std::size_t k) { return float((p * (k + 3)) % 17) / 6 - 1.4f; };
    smoke.positions.push_back(at);
    smoke.log_deviations.push_back({size, size, size});
    smoke.rotations.push_back({1, 0, 0, 0});
    smoke.logits.push_back(-1.5f);
    for (std::size_t k = 0; k < 3; ++k) smoke.harmonics.push_back(shade(k));
    capture.cloud.positions.push_back(at);
  }
  const GaussianRenderer renderer(smoke, {.background = {0, 0, 0}});
  for (std::size_t i = 0; i < capture.images.size(); ++i)
    capture.images[i] = renderer.render(capture.cameras[i]).image;
  const auto coded = encode(capture, traced.cameras, {});
  ASSERT_TRUE(coded) << coded.error().message;
  const SurfaceReport& report = coded->surface;
  EXPECT_EQ(report.kept, Surface::kSplats);
  EXPECT_GT(report.splats_psnr, std::max(report.before_psnr, report.trained_psnr) + 3.5);
  EXPECT_TRUE(has_gaussians(decode(coded->stream)->header));
  EncoderSettings settings;
  EXPECT_TRUE(may_be_splats(settings));
  settings.q = 16;
  EXPECT_FALSE(may_be_splats(settings)) << "a step of a surface";
}

TEST(EncodeSplats, WinBySoMuchAtNoMoreBytes) {
  SurfaceReport report;
  report.before_psnr = 25;
  report.trained_psnr = 27;
  report.splats_psnr = 30.6;
  report.splats_bytes = 50'000;
  EXPECT_TRUE(splats_win(report, 100'000));
  EXPECT_FALSE(splats_win(report, 80'000)) << "a surface is smaller";
  report.splats_psnr = 30.4;
  EXPECT_FALSE(splats_win(report, 100'000)) << "the surface's fit will gain that";
  report.trained_psnr = 24;
  EXPECT_TRUE(splats_win(report, 100'000));
}

}  // namespace
}  // namespace slf::choose_splats_test
