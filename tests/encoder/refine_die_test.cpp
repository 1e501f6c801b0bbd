// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <string>

#include "encoder/fit/observe_depth.h"
#include "encoder/refine/refine_geometry.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/synth.h"
#include "tools/synth/trace.h"

namespace slf::synth {
static void PrintTo(const DisturbSettings& settings, std::ostream* out) {
  *out << (settings.hull > 0 ? "hull" : "noise");
}
}  // namespace slf::synth

namespace slf::refine_die_test {
namespace {

/// A translucent, glossy die: the photographs agree best where its mirror images are, far inside.
struct DieCapture {
  Capture capture;
  PointCloud exact;
  std::vector<int> cameras;
  double step = 0;

  explicit DieCapture(const synth::DisturbSettings& disturbed) {
    const auto scene = synth::make_scene("die");
    const auto rings = synth::make_rings(5, 12, 120, 120, scene->bounds().radius);
    for (const Camera& camera : rings.cameras) {
      cameras.push_back(int(cameras.size()));
      capture.cameras.push_back(camera);
      capture.images.push_back(synth::trace_image(*scene, camera, 2));
    }
    exact = synth::sample_points(*scene, 20000, 2, &step);
    capture.cloud = exact;
    synth::disturb(capture.cloud, step, disturbed);
  }
};

class RefineDieTest : public testing::TestWithParam<synth::DisturbSettings> {};

TEST_P(RefineDieTest, WhatPhotographsShowStaysCovered) {
  const DieCapture die(GetParam());
  const Capture& capture = die.capture;
  const PointCloud& exact = die.exact;
  const double step = die.step;
  const auto refined =
      refine_geometry(capture, die.cameras, {.mode = RefineGeometry::kOn, .grid_bits = 8});
  ASSERT_TRUE(refined);
  if (refined->report.outcome != RefineReport::kMended) return;  // refused: nothing is uncovered
  // Nearer to the outline than two pixels a surface may be right without covering a pixel.
  std::size_t shown = 0, lost = 0;
  const DepthSettings depth{1, step, 2.5};
  for (const Camera& camera : capture.cameras) {
    const DepthBuffer is(camera, refined->cloud.positions, depth),
        truth(camera, exact.positions, depth);
    for (int y = 2; y + 2 < camera.height; ++y)
      for (int x = 2; x + 2 < camera.width; ++x) {
        bool inside = true;
        for (const double v : {y - 1.5, y + 0.5, y + 2.5})
          for (const double u : {x - 1.5, x + 0.5, x + 2.5})
            inside = inside && truth.hides({u, v}, 1e30, 1);
        shown += inside;
        lost += inside && !is.hides({x + 0.5, y + 0.5}, 1e30, 1);
      }
  }
  RecordProperty("lost", std::to_string(double(lost) / double(shown)));
  EXPECT_LT(double(lost), 0.003 * double(shown));
}

INSTANTIATE_TEST_SUITE_P(, RefineDieTest,
                         testing::Values(synth::DisturbSettings{.hull = 4},
                                         synth::DisturbSettings{.noise = 0.7, .noise_scale = 6}),
                         testing::PrintToStringParamName());

/// What mending gains there is its smoothing of points: the file grows by a fifth, its pictures do
/// not get better (docs/decisions/019).
TEST(RefineNoisyDieTest, AGainThatPicturesDoNotShowLeavesTheCloudAlone) {
  const DieCapture die({.noise = 0.7, .noise_scale = 6});
  const auto refined = refine_geometry(die.capture, die.cameras, {.grid_bits = 8});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kNoGain);
}

}  // namespace
}  // namespace slf::refine_die_test
