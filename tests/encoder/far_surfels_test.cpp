// SPDX-License-Identifier: Apache-2.0
// What photographs show behind everything that has points.
#include "encoder/train/far_surfels.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "encoder/train/train_gaussians.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/evaluate.h"
#include "slf/gaussian_renderer.h"
#include "slf/render.h"
#include "traced_scene.h"

namespace slf::far_surfels_test {
namespace {

/// A camera at (x, 0, 0) that looks along +z: red on the left, blue on the right.
TrainingView view_from(float x) {
  TrainingView view;
  TrainingCamera& camera = view.camera;
  camera.width = 192, camera.height = 96;
  camera.fx = camera.fy = 96;
  camera.cx = 96, camera.cy = 48;
  camera.rotation = {Float3{1, 0, 0}, Float3{0, 1, 0}, Float3{0, 0, 1}};
  camera.centre = {x, 0, 0};
  camera.translation = {-x, 0, 0};
  camera.depth = 4;
  camera.gaussian = true;
  view.picture = {192, 96, std::vector<float>(3 * 192 * 96)};
  for (std::size_t i = 0; i < view.picture.pixels(); ++i)
    view.picture.plane(i % 192 < 96 ? 0 : 2)[i] = 0.75f;
  return view;
}

TEST(FarSurfels, StandWherePhotographsShowSomethingBehindAllPoints) {
  const std::vector<TrainingView> views = {view_from(-0.1f), view_from(0.1f)};
  TrainedSurfels wall;
  for (float x = -5; x < -0.4f; x += 0.5f)
    for (float y = -3; y <= 3; y += 0.5f)
      wall.push_back(flat_surfel({x, y, 4}, {0, 0, -1}, 1.2f, 0.999f));
  const TrainedSurfels far = far_surfels(views, wall, 1000, 1);
  const ViewedSpace space = viewed_space(views);
  ASSERT_GT(far.size(), 3u);
  for (const TrainedSurfel& surfel : far) {
    const Float3 at = surfel.position(), from = minus(at, space.centre);
    EXPECT_GT(at[0], 0) << "the wall hides the left";
    EXPECT_GT(at[2], 0);
    EXPECT_GT(std::sqrt(dot(from, from)), 2 * space.radius);
    EXPECT_GT(space.pixels_at(at), 2);
    EXPECT_LT(surfel.value[TrainedSurfel::kColour], 0) << "no red";
    EXPECT_GT(surfel.value[TrainedSurfel::kColour + 2], 0) << "blue";
  }
  EXPECT_EQ(space.pixels_at(wall[0].position()), 1);
  EXPECT_LE(far_surfels(views, wall, 3, 1).size(), 3u);
  EXPECT_TRUE(far_surfels(views, wall, 0, 1).empty());
}

TEST(FarSurfels, AreFiniteOrNoneWhereCamerasAreTooFarAway) {
  for (const float x : {1e12f, 1e20f, 1e38f}) {
    const std::vector<TrainingView> views = {view_from(-x), view_from(x)};
    for (const TrainedSurfel& surfel : far_surfels(views, {}, 1000, 1))
      for (const float value : surfel.value) EXPECT_TRUE(std::isfinite(value)) << x;
  }
}

TEST(FarSurfels, AreFewAndNoLargerThanTheSceneAroundWhereFewAreAskedFor) {
  std::vector<TrainingView> views(4, view_from(0));
  const std::array<Float3, 4> forward = {Float3{0, 0, 1}, {1, 0, 0}, {0, 0, -1}, {-1, 0, 0}};
  for (std::size_t i = 0; i < views.size(); ++i) {
    const Float3& z = forward[i];
    views[i].camera.rotation = {Float3{z[2], 0, -z[0]}, Float3{0, 1, 0}, z};
  }
  const float radius = viewed_space(views).radius;
  for (const std::size_t most : {1u, 3u, 7u, 30u}) {
    const TrainedSurfels far = far_surfels(views, {}, most, 1);
    EXPECT_LE(far.size(), most);
    ASSERT_FALSE(far.empty());
    for (const TrainedSurfel& surfel : far)
      EXPECT_LT(surfel.radius(0), 20 * radius) << "of " << most;
  }
}

/// Stripes by direction, as of a sky.
void paint_sky(Capture& capture) {
  for (std::size_t c = 0; c < capture.images.size(); ++c) {
    Image& image = capture.images[c];
    const Camera& camera = capture.cameras[c];
    const auto channels = std::size_t(image.channels);
    const std::array<std::uint8_t, 3> plain = {image.data[0], image.data[1], image.data[2]};
    for (int y = 0; y < image.height; ++y)
      for (int x = 0; x < image.width; ++x) {
        std::uint8_t* pixel =
            &image.data[channels * (std::size_t(y) * std::size_t(image.width) + std::size_t(x))];
        if (!std::equal(plain.begin(), plain.end(), pixel)) continue;
        const double u = (x + 0.5 - camera.cx) / camera.fx, v = (y + 0.5 - camera.cy) / camera.fy;
        for (std::size_t k = 0; k < 3; ++k) {
          const auto& r = camera.rotation;
          const double along = (u * r[0][k] + v * r[1][k] + r[2][k]) / std::sqrt(u * u + v * v + 1);
          pixel[k] = std::uint8_t(128 + 100 * std::sin(4 * along));
        }
      }
  }
}

TEST(FarSurfels, DrawTheSkyOfPhotographsThatTrainedNothingOfIt) {
  test::TracedScene traced("vase", 4, 12, 48, 2000);
  paint_sky(traced.capture);
  traced.capture.cloud = traced.exact;
  std::vector<int> fitted, held_out;
  for (const int c : traced.cameras) (c % 8 == 4 ? held_out : fitted).push_back(c);
  EncoderSettings settings;
  settings.surface = Surface::kSplats;
  settings.target_bytes = 30'000;
  const auto coded = encode(traced.capture, fitted, settings);
  ASSERT_TRUE(coded) << coded.error().message;
  const auto splats = gaussians_of(*decode(coded->stream));
  const GaussianRenderer renderer(*splats, {.background = {0, 0, 0}});
  const auto draw = [&](const Camera& camera) { return renderer.render(camera); };
  const auto quality = evaluate_pictures(draw, traced.capture, held_out, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_GT(quality->image.coverage, 0.9);
  EXPECT_GT(quality->image.all.psnr, 20);

  const auto info = read_info(coded->stream);
  const auto view = named_view(info->metadata, splats->up, 40, 30);
  ASSERT_TRUE(view) << "of a camera, not of an orbit about the sky";
  double nearest = 1e9;
  for (const int c : fitted) {
    double square = 0;
    for (std::size_t k = 0; k < 3; ++k)
      square += std::pow(view->centre()[k] - traced.capture.cameras[std::size_t(c)].centre()[k], 2);
    nearest = std::min(nearest, square);
  }
  EXPECT_LT(nearest, 1e-6);
}

TEST(NamedView, IsTheOneThatMetadataDescribesOrNone) {
  const auto view = named_view({{"a", "b"}, {"view", "0 -5 1 0 0 1 40"}}, UpAxis::kPlusZ, 80, 60);
  ASSERT_TRUE(view);
  const Vec3 eye = view->centre();
  EXPECT_NEAR(eye[0], 0, 1e-9);
  EXPECT_NEAR(eye[1], -5, 1e-9);
  EXPECT_NEAR(eye[2], 1, 1e-9);
  const auto middle = view->project({0, 0, 1});
  ASSERT_TRUE(middle);
  EXPECT_NEAR((*middle)[0], 40, 1e-9);
  EXPECT_NEAR((*middle)[1], 30, 1e-9);
  EXPECT_NEAR(view->fy, 30 / std::tan(20 * std::acos(-1.0) / 180), 1e-9);
  EXPECT_LT((*view->project({0, 0, 2}))[1], 30) << "up is up";
  for (const char* none : {"", "1 2 3", "0 0 0 0 0 0 40", "0 -5 1 0 0 1 0.5", "0 -5 1 0 0 1 171",
                           "nan -5 1 0 0 1 40", "inf -5 1 0 0 1 40", "1e300 0 0 -1e300 0 0 40",
                           "0  -5 1 0 0 1 40", "0 -5 1 0 0 1 40 2", "0,-5,1,0,0,1,40"})
    EXPECT_FALSE(named_view({{"view", none}}, UpAxis::kPlusZ, 80, 60)) << none;
  EXPECT_FALSE(named_view({}, UpAxis::kPlusZ, 80, 60));
}

}  // namespace
}  // namespace slf::far_surfels_test
