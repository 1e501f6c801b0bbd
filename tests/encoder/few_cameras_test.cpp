// SPDX-License-Identifier: Apache-2.0
// Captures whose cameras are few and lie far apart.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "encoder/fit_capture.h"
#include "slf/camera_trust.h"
#include "slf/encoder.h"
#include "tools/synth/synth.h"

namespace slf::few_cameras_test {
namespace {

TEST(FewCameras, ThatBelongAreKept) {
  const auto root =
      std::filesystem::path(testing::TempDir()) / ("slf_few_cameras_" + std::to_string(getpid()));
  std::filesystem::remove_all(root);
  synth::SynthSettings settings;
  settings.scene = "can";
  settings.width = 200;
  settings.height = 150;
  settings.circles = 3;
  settings.per_circle = 12;
  const auto made = synth::synthesise(settings, root, {});
  ASSERT_TRUE(made) << made.error().message;
  const auto capture = load_capture(root);
  ASSERT_TRUE(capture) << capture.error().message;
  for (const std::vector<int>& few :
       {std::vector<int>{0, 6, 12, 24, 30}, {0, 5, 10, 15, 20, 25, 30}, {0, 7, 14, 21, 28, 35}}) {
    EncoderSettings plain = settings_of(Preset::kDefault, 3);
    plain.surface = Surface::kGiven;
    const auto cloud = voxelise_capture(*capture, few, plain);
    ASSERT_TRUE(cloud);
    const ObservedPoints points = world_points(*cloud);
    const auto seen = observe(*capture, few, points, points.positions, cloud->grid.step, {});
    ASSERT_TRUE(seen) << seen.error().message;
    const auto trust = check_cameras(*seen, 0);
    ASSERT_TRUE(trust) << trust.error().message;
    for (const CameraTrust& t : *trust)
      EXPECT_NE(t.verdict, CameraVerdict::kDropped) << t.camera << ", " << reason_of(t);
  }
  std::filesystem::remove_all(root);
}

}  // namespace
}  // namespace slf::few_cameras_test
