// SPDX-License-Identifier: Apache-2.0
// Splats are an object's, before any background.
#include "encoder/train/empty_pixels.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "encoder/train/train_gaussians.h"
#include "slf/gaussian_renderer.h"
#include "traced_scene.h"

namespace slf::empty_pixels_test {
namespace {

class EmptyPixelsTest : public testing::Test {
 protected:
  void SetUp() override {
    capture_.cloud = traced_.exact;
    const SurfacePoints points{traced_.exact.positions, traced_.exact.normals, {}};
    auto views = load_training_views(capture_, traced_.cameras, points, traced_.step, 0, 0);
    ASSERT_TRUE(views) << views.error().message;
    views_ = *std::move(views);
    const auto charged = charge_for_hiding(capture_, 0, views_);
    ASSERT_TRUE(charged) << charged.error().message;
  }

  /// Whether a square around a pixel has the background's colour alone.
  static bool is_plain(const TrainingView& view, int x, int y, int reach) {
    const PlanarPicture& picture = view.picture;
    for (int v = std::max(y - reach, 0); v <= std::min(y + reach, picture.height - 1); ++v)
      for (int u = std::max(x - reach, 0); u <= std::min(x + reach, picture.width - 1); ++u)
        for (std::size_t c = 0; c < 3; ++c)
          if (picture.plane(c)[v * picture.width + u] != view.background[c]) return false;
    return true;
  }

  const test::TracedScene traced_{"can", 4, 8, 64, 3000};
  Capture capture_ = traced_.capture;
  std::vector<TrainingView> views_;
};

TEST_F(EmptyPixelsTest, HidingCostsWhereNoObjectIsNearAndNowhereElse) {
  for (const TrainingView& view : views_) {
    ASSERT_EQ(view.hiding.size(), view.picture.pixels());
    for (int y = 0, i = 0; y < view.picture.height; ++y)
      for (int x = 0; x < view.picture.width; ++x, ++i) {
        const float cost = view.hiding[std::size_t(i)];
        SCOPED_TRACE(testing::Message() << view.index << ": " << x << ", " << y);
        EXPECT_TRUE(cost == 0 || is_plain(view, x, y, 1));
        EXPECT_TRUE(cost > 0 || !is_plain(view, x, y, 12));
      }
  }
}

TEST_F(EmptyPixelsTest, AHalfCostsWhereAllFourPixelsDo) {
  const TrainingView small = half(views_[0]);
  ASSERT_EQ(small.hiding.size(), small.picture.pixels());
  const auto at = [&](int x, int y) { return views_[0].hiding[std::size_t(64 * y + x)]; };
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const bool all = at(2 * x, 2 * y) > 0 && at(2 * x + 1, 2 * y) > 0 &&
                       at(2 * x, 2 * y + 1) > 0 && at(2 * x + 1, 2 * y + 1) > 0;
      EXPECT_EQ(small.hiding[std::size_t(32 * y + x)] > 0, all) << x << ", " << y;
    }
}

TEST_F(EmptyPixelsTest, SplatsHideNextToNothingThere) {
  Capture fat = capture_;
  for (std::size_t p = 0; p < fat.cloud.positions.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a)
      fat.cloud.positions[p][a] += 0.1f * float(traced_.radius) * fat.cloud.normals[p][a];
  TrainGeometrySettings settings;
  settings.iterations = 1000;
  settings.surfels = 800;
  const auto splats = train_gaussians(fat, traced_.cameras, settings);
  ASSERT_TRUE(splats) << splats.error().message;
  const GaussianRenderer renderer(*splats, {});
  double hidden = 0, empty = 0;
  for (const TrainingView& view : views_) {
    const Rendering drawn = renderer.render(capture_.cameras[std::size_t(view.index)]);
    for (std::size_t i = 0; i < view.hiding.size(); ++i)
      if (view.hiding[i] > 0) hidden += drawn.coverage[i] / 255.0, ++empty;
  }
  EXPECT_LT(hidden / empty, 0.0002) << "0.0004 where it costs nothing";
}

}  // namespace
}  // namespace slf::empty_pixels_test
