// SPDX-License-Identifier: Apache-2.0
// Blocks of a tile that a surfel may touch, sums over their lanes, and what trainings share.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "encoder/train/chance.h"
#include "encoder/train/tile_pixels.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/training_view.h"
#include "traced_scene.h"

namespace slf::training_tiles_test {
namespace {

/// An ellipse around (u, v) of two radii, pixels, turned.
ProjectedSurfel ellipse(float u, float v, float first, float second, float turn, float reach) {
  const float c = std::cos(turn), s = std::sin(turn);
  const float uu = first * first * c * c + second * second * s * s;
  const float uv = (first * first - second * second) * c * s;
  const float vv = first * first * s * s + second * second * c * c;
  const float determinant = uu * vv - uv * uv;
  ProjectedSurfel out;
  out.u = u, out.v = v, out.reach = reach;
  out.a = vv / determinant, out.b = -uv / determinant, out.c = uu / determinant;
  out.half_width = std::sqrt(uu * reach), out.half_height = std::sqrt(vv * reach);
  return out;
}

/// Blocks of the tile at (16, 32) with a pixel centre in the ellipse, pixel by pixel.
BlockSet blocks_by_pixels(const ProjectedSurfel& s) {
  BlockSet out = 0;
  for (int y = 0; y < kTileSide; ++y)
    for (int x = 0; x < kTileSide; ++x) {
      const float du = 16.5f + float(x) - s.u, dv = 32.5f + float(y) - s.v;
      if (du * (s.a * du + 2 * s.b * dv) + s.c * dv * dv < s.reach)
        out |= BlockSet{1} << (kTileBlocks * (y / kBlockRows) + x / kBlockColumns);
    }
  return out;
}

TEST(TrainingTiles, NoBlockThatAnEllipseTouchesIsLeftOutAndFewOthersAreIn) {
  Chance chance{5};
  int touched = 0, kept = 0;
  for (int i = 0; i < 20'000; ++i) {
    const auto draw = [&](double low, double high) {
      return float(low + (high - low) * chance.share());
    };
    const auto s = ellipse(draw(0, 48), draw(16, 64), std::exp(draw(-0.5, 4)),
                           std::exp(draw(-0.5, 2)), draw(0, 3.2), draw(0.2, 1));
    const BlockSet is = blocks_of(s, 16, 32), exact = blocks_by_pixels(s);
    EXPECT_EQ(exact & ~is, 0u) << i;
    touched += std::popcount(exact);
    kept += std::popcount(is);
  }
  EXPECT_GT(touched, 20'000);
  EXPECT_LT(kept, 1.01 * touched);
}

TEST(TrainingTiles, AnEllipseThatIsNoneTouchesNothingAndEndsNothing) {
  auto s = ellipse(24, 40, 5, 3, 0.3f, 1);
  s.u = std::nanf("");
  EXPECT_EQ(blocks_of(s, 16, 32), 0u);
  EXPECT_EQ(blocks_of(ellipse(1e30f, 40, 5, 3, 0.3f, 1), 16, 32), 0u);
}

TEST(TrainingTiles, SumsOfEightVectorsAreInTheirOrder) {
  std::array<Lanes, 8> v{};
  for (int i = 0; i < 8; ++i)
    for (int k = 0; k < 8; ++k) v[std::size_t(i)][k] = float(100 * i + k * k);
  Lanes sums;
  set_sums(v, sums);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(sums[i], float(800 * i + 140));
}

TEST(TrainingCache, GivesTheViewsThatATrainingWouldFind) {
  const test::TracedScene traced("vase", 2, 4, 48, 1000);
  const SurfacePoints points{traced.exact.positions, traced.exact.normals, {}};
  TrainingCache cache;
  const auto load = [&](TrainingCache* known) {
    return *load_training_views(traced.capture, traced.cameras, points, traced.step, 0, 1, known);
  };
  const auto expected = load(nullptr);
  for (int again = 0; again < 2; ++again) {
    const auto views = load(&cache);
    ASSERT_EQ(views.size(), expected.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
      EXPECT_EQ(views[i].background, expected[i].background);
      EXPECT_EQ(views[i].camera.depth, expected[i].camera.depth);
      EXPECT_EQ(views[i].picture.value, expected[i].picture.value);
    }
  }
  cache.views[std::size_t(traced.cameras[0])]->depth = 7;
  EXPECT_EQ(load(&cache)[0].camera.depth, 7) << "it is not looked for again";
}

TEST(TrainingViews, APhotographThatShowsNoPointIsAsFarAsTheOthers) {
  test::TracedScene traced("vase", 2, 4, 48, 1000);
  const SurfacePoints points{traced.exact.positions, traced.exact.normals, {}};
  Camera& away = traced.capture.cameras[std::size_t(traced.cameras[0])];
  for (std::size_t axis : {0u, 2u}) {  // it looks the other way
    for (double& value : away.rotation[axis]) value = -value;
    away.translation[axis] = -away.translation[axis];
  }
  const auto views =
      *load_training_views(traced.capture, traced.cameras, points, traced.step, 0, 1);
  std::vector<float> depths;
  for (std::size_t i = 1; i < views.size(); ++i) depths.push_back(views[i].camera.depth);
  const auto [low, high] = std::minmax_element(depths.begin(), depths.end());
  EXPECT_GE(views[0].camera.depth, *low);
  EXPECT_LE(views[0].camera.depth, *high);
}

TEST(StartSurfels, AreNoMoreThanTwiceWhatIsAskedForOfPointsAlongLines) {
  SurfacePoints lines;
  for (int line = 0; line < 40; ++line)
    for (int i = 0; i < 1000; ++i) {
      lines.positions.push_back({float(i) * 1e-3f, float(line) * 0.5f, 5});
      lines.normals.push_back({0, 0, -1});
    }
  const std::size_t some = start_surfels(lines, 1e-3, {}, 250, 0.9f, 1).size();
  EXPECT_LE(some, 500u);
  EXPECT_GE(some, 60u);
}

}  // namespace
}  // namespace slf::training_tiles_test
