// SPDX-License-Identifier: Apache-2.0
// Poses that are wrong by parts of a pixel are found, by photographs alone.
#include "encoder/train/refine_cameras.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "encoder/train/camera_twists.h"
#include "slf/evaluate.h"
#include "slf/gaussian_renderer.h"
#include "traced_scene.h"

namespace slf::refine_cameras_test {
namespace {

/// Root mean square of how far pictures of the points lie apart, pixels, over cameras.
double apart(const Capture& a, const Capture& b, std::span<const int> cameras) {
  double squares = 0;
  std::size_t count = 0;
  for (const int c : cameras)
    for (std::size_t p = 0; p < a.cloud.positions.size(); p += 50) {
      const auto& at = a.cloud.positions[p];
      const Vec3 world{at[0], at[1], at[2]};
      const auto u = a.cameras[std::size_t(c)].project(world),
                 v = b.cameras[std::size_t(c)].project(world);
      if (!u || !v) continue;
      squares += std::pow((*u)[0] - (*v)[0], 2) + std::pow((*u)[1] - (*v)[1], 2);
      ++count;
    }
  return std::sqrt(squares / double(count));
}

/// A die in 36 small photographs, with cameras that stand where they should, and a little off.
class RefineCamerasTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const test::TracedScene traced("die", 3, 12, 96, 6000);
    right_ = traced.capture;
    right_.cloud = traced.exact;
    cameras_ = traced.cameras;
    wrong_ = right_;
    for (const int c : cameras_) {
      Camera& camera = wrong_.cameras[std::size_t(c)];
      const double pixel = traced.radius / 48;  // about: of a world in 96 pixels
      const auto drawn = [&](int k) { return std::sin(12.9898 * c + 78.233 * k); };  // -1 .. 1
      camera = twisted(camera,
                       {pixel * drawn(1), pixel * drawn(2), pixel * drawn(3), 0.01 * drawn(4),
                        0.01 * drawn(5), 0.01 * drawn(6)},
                       {0, 0, 0});
    }
  }

  static TrainGeometrySettings settings(int threads) {
    TrainGeometrySettings s;
    s.iterations = 1200;
    s.surfels = 1500;
    s.threads = threads;
    return s;
  }

  static inline Capture right_, wrong_;
  static inline std::vector<int> cameras_;
};

TEST_F(RefineCamerasTest, PosesThatAreWrongByPartsOfAPixelAreFound) {
  const auto report = refine_cameras(wrong_, cameras_, settings(0), {});
  ASSERT_TRUE(report) << report.error().message;
  Capture refined = wrong_;
  refined.cameras = report->cameras;
  const double before = apart(right_, wrong_, cameras_), after = apart(right_, refined, cameras_);
  EXPECT_GT(before, 0.5);
  EXPECT_LT(after, before / 2);
  EXPECT_GT(report->median_pixels, before / 2);
  EXPECT_GE(report->most_pixels, report->median_pixels);
}

TEST_F(RefineCamerasTest, RightPosesStayWithinATenthOfAPixelOrTwo) {
  const auto report = refine_cameras(right_, cameras_, settings(0), {});
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_LT(report->median_pixels, 0.2);
}

TEST_F(RefineCamerasTest, CamerasThatAreNotUsedStayAndThreadsChangeNothing) {
  const std::vector<int> some(cameras_.begin(), cameras_.begin() + 24);
  TrainGeometrySettings one = settings(1), three = settings(3);
  one.iterations = three.iterations = 200;
  const auto a = refine_cameras(wrong_, some, one, {}), b = refine_cameras(wrong_, some, three, {});
  ASSERT_TRUE(a && b);
  for (std::size_t c = 0; c < wrong_.cameras.size(); ++c) {
    EXPECT_EQ(a->cameras[c].rotation, b->cameras[c].rotation);
    EXPECT_EQ(a->cameras[c].translation, b->cameras[c].translation);
    EXPECT_EQ(a->cameras[c].translation == wrong_.cameras[c].translation, c >= 24);
  }
}

/// An aligned picture is that of a camera that stands right.
TEST_F(RefineCamerasTest, AJudgeThatAlignsCamerasSeesNoErrorOfPoses) {
  const DrawPicture truth = [&](const Camera& camera) {
    static const auto scene_of_die = synth::make_scene("die");
    const synth::Scene& scene = *scene_of_die;
    Rendering drawn;
    drawn.image = synth::trace_image(scene, camera, 2);
    drawn.coverage.resize(std::size_t(camera.width) * std::size_t(camera.height));
    for (std::size_t i = 0; i < drawn.coverage.size(); ++i)
      drawn.coverage[i] = drawn.image.channels == 4 ? drawn.image.data[4 * i + 3] : 255;
    if (drawn.image.channels == 4) {
      Image rgb{drawn.image.width, drawn.image.height, 3, {}};
      for (std::size_t i = 0; i < drawn.coverage.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k)
          rgb.data.push_back(std::uint8_t(drawn.image.data[4 * i + k] * drawn.coverage[i] / 255));
      drawn.image = std::move(rgb);
    }
    return drawn;
  };
  EvaluateSettings judging;
  const auto as_given = evaluate_pictures(truth, wrong_, cameras_, judging);
  judging.align_cameras = true;
  const auto aligned = evaluate_pictures(truth, wrong_, cameras_, judging);
  ASSERT_TRUE(as_given && aligned);
  EXPECT_GT(as_given->image.off_pixels, 0.3);
  EXPECT_GT(aligned->image.psnr, as_given->image.psnr + 5);
}

}  // namespace
}  // namespace slf::refine_cameras_test
