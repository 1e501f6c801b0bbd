// SPDX-License-Identifier: Apache-2.0
// Where training starts when a capture has no points.
#include "encoder/train/starting_points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/mesh_sampling.h"
#include "capture/nearest.h"
#include "capture/object_outline.h"
#include "capture/surface_points.h"
#include "encoder/encode_warnings.h"
#include "encoder/other_start.h"
#include "encoder/train/chance.h"
#include "encoder/train/object_points.h"
#include "slf/encoder.h"
#include "traced_scene.h"

namespace slf::starting_points_test {
namespace {

/// A can before grey, in small photographs, without points.
class StartingPointsTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { traced_ = new test::TracedScene("can", 4, 6, 96, 3000, 1); }
  static void TearDownTestSuite() { delete traced_; }

  /// With stripes of the photograph's own behind the object.
  static Capture before_stripes() {
    Capture capture = traced_->capture;
    for (std::size_t i = 0; i < capture.images.size(); ++i) {
      Image& image = capture.images[i];
      const auto object = object_outline(image);
      for (std::size_t p = 0; p < object.size(); ++p)
        for (std::size_t c = 0; c < 3 && !object[p]; ++c)
          image.data[3 * p + c] = std::uint8_t(40 * ((p / 7 + i + c) % 6));
    }
    return capture;
  }
  /// The same photographs, their backgrounds taken away by alpha.
  static Capture with_alpha(Capture capture) {
    for (std::size_t i = 0; i < capture.images.size(); ++i) {
      const auto object = object_outline(traced_->capture.images[i]);
      Image image = capture.images[i];
      image.channels = 4;
      image.data.clear();
      for (std::size_t p = 0; p < object.size(); ++p) {
        for (std::size_t c = 0; c < 3; ++c) image.data.push_back(capture.images[i].data[3 * p + c]);
        image.data.push_back(object[p] ? 255 : 0);
      }
      capture.images[i] = image;
    }
    return capture;
  }

  /// The capture with some of the object's points, and `strays` anywhere around the cameras' axes.
  static Capture with_strays(std::size_t points, std::size_t strays) {
    Capture capture = traced_->capture;
    Chance chance{1};
    const std::size_t every = traced_->exact.positions.size() / points;
    for (std::size_t p = 0; p < points; ++p)
      capture.cloud.positions.push_back(traced_->exact.positions[p * every]);
    for (std::size_t s = 0; s < strays; ++s) {
      std::array<float, 3> at{};
      for (float& x : at) x = float((4 * chance.share() - 2) * traced_->radius);
      capture.cloud.positions.push_back(at);
    }
    return capture;
  }

  static inline test::TracedScene* traced_ = nullptr;
};

TEST_F(StartingPointsTest, PointsOutsideOfTheObjectAreLeftOutWhereTheyAreMany) {
  const Capture capture = with_strays(400, 4000);
  const auto own = object_points(capture, traced_->cameras, 0);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_GT(own->left_out, 3000u);
  EXPECT_EQ(own->left_out + own->cloud.positions.size(), capture.cloud.positions.size());
  std::size_t kept = 0;
  for (std::size_t p = 0; p < 400; ++p)
    kept += std::count(own->cloud.positions.begin(), own->cloud.positions.end(),
                       capture.cloud.positions[p]) > 0;
  EXPECT_GT(kept, 360u);  // some bare metal is as grey as what is behind it
  const auto few = object_points(with_strays(400, 40), traced_->cameras, 0);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->left_out, 0u);
}

TEST_F(StartingPointsTest, StraysDoNotChangeWhereTrainingStarts) {
  EncoderSettings settings;
  settings.surface = Surface::kSplats;
  const auto clean = other_start(with_strays(400, 0), traced_->cameras, settings);
  const auto strewn = other_start(with_strays(400, 4000), traced_->cameras, settings);
  ASSERT_TRUE(clean && strewn && *clean && *strewn);
  EXPECT_EQ((*clean)->start, StartId::kHull);
  EXPECT_EQ((*strewn)->start, StartId::kHull);
  EXPECT_EQ((*clean)->cloud.positions, (*strewn)->cloud.positions);
  EXPECT_EQ((*clean)->left_out, 0u);
  EXPECT_GT((*strewn)->left_out, 3000u);
}

TEST_F(StartingPointsTest, CamerasLookAtTheObject) {
  const auto ball = looked_at(traced_->capture, traced_->cameras);
  ASSERT_TRUE(ball);
  for (const double x : ball->centre) EXPECT_NEAR(x, 0, 0.1 * traced_->radius);
  EXPECT_GT(ball->radius, 0.9 * traced_->radius);
  EXPECT_LT(ball->radius, 4 * traced_->radius);
}

TEST_F(StartingPointsTest, TheHullOfAnEvenBackgroundLiesAroundTheObject) {
  const auto points = starting_points(traced_->capture, traced_->cameras, 0);
  ASSERT_TRUE(points);
  EXPECT_EQ(points->start, StartId::kHull);
  const PointCloud& hull = points->cloud;
  ASSERT_EQ(hull.normals.size(), hull.positions.size());
  const NearestPoints tree(traced_->exact.positions);
  std::size_t outside = 0, alike = 0;
  double farthest = 0;
  for (std::size_t p = 0; p < hull.positions.size(); ++p) {
    std::uint32_t nearest = 0;
    tree.nearest(hull.positions[p], 1, &nearest, nullptr);
    const Float3& normal = traced_->exact.normals[nearest];
    const float apart = dot(minus(hull.positions[p], traced_->exact.positions[nearest]), normal);
    outside += double(apart) > -0.05 * traced_->radius;
    alike += dot(normal, hull.normals[p]) > 0;
    farthest = std::max(farthest, double(std::abs(apart)));
  }
  // Some bare metal is as grey as what is behind it.
  EXPECT_GT(double(outside), 0.9 * double(hull.positions.size()));
  EXPECT_GT(double(alike), 0.9 * double(hull.positions.size()));
  EXPECT_LT(farthest, 0.5 * traced_->radius);
}

TEST_F(StartingPointsTest, AlphaCarvesAsAnEvenBackgroundDoes) {
  const auto by_colour = starting_points(traced_->capture, traced_->cameras, 0);
  const auto by_alpha = starting_points(with_alpha(before_stripes()), traced_->cameras, 0);
  ASSERT_TRUE(by_colour && by_alpha);
  EXPECT_EQ(by_alpha->start, StartId::kHull);
  EXPECT_EQ(by_alpha->cloud.positions, by_colour->cloud.positions);
}

TEST_F(StartingPointsTest, WhereNothingTellsTheObjectPointsAreAnywhere) {
  const auto points = starting_points(before_stripes(), traced_->cameras, 0);
  ASSERT_TRUE(points);
  EXPECT_EQ(points->start, StartId::kVolume);
  EXPECT_GT(points->cloud.positions.size(), 1000u);
}

TEST_F(StartingPointsTest, AllBlackMasksAreNoOutline) {
  Capture capture = traced_->capture;
  for (Image& image : capture.images) {
    image.channels = 4;
    image.data.assign(image.data.size() / 3 * 4, 0);
  }
  const auto points = starting_points(capture, traced_->cameras, 0);
  ASSERT_TRUE(points);
  EXPECT_EQ(points->start, StartId::kVolume);
}

TEST_F(StartingPointsTest, TheSameForAnyNumberOfThreads) {
  const auto one = starting_points(traced_->capture, traced_->cameras, 1);
  const auto three = starting_points(traced_->capture, traced_->cameras, 3);
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->cloud.positions, three->cloud.positions);
  EXPECT_EQ(one->cloud.normals, three->cloud.normals);
}

TEST_F(StartingPointsTest, CamerasThatLookApartOrTheSameWayAreRefused) {
  Capture row = traced_->capture, room = traced_->capture;
  for (std::size_t i = 0; i < row.cameras.size(); ++i) {
    row.cameras[i].rotation = row.cameras[0].rotation;
    row.cameras[i].translation = row.cameras[0].translation;
    row.cameras[i].translation[0] += double(i);
    Camera& outwards = room.cameras[i];  // turned about its own upright axis, where it stands
    for (const std::size_t r : {0u, 2u}) {
      for (double& x : outwards.rotation[r]) x = -x;
      outwards.translation[r] = -outwards.translation[r];
    }
  }
  for (const Capture* capture : {&row, &room}) {
    const auto points = starting_points(*capture, traced_->cameras, 0);
    ASSERT_FALSE(points);
    EXPECT_EQ(points.error().code, Errc::kInvalidInput);
    EXPECT_NE(points.error().message.find("give points"), std::string::npos);
  }
}

TEST_F(StartingPointsTest, PhotographsAndCamerasBecomeALightField) {
  EncoderSettings settings = settings_of(Preset::kDefault, 1);
  settings.surface = Surface::kGiven;
  const auto encoded = encode(traced_->capture, traced_->cameras, settings);
  ASSERT_TRUE(encoded) << encoded.error().message;
  EXPECT_EQ(encoded->surface.start, StartId::kHull);
  EXPECT_GT(encoded->points, 1000u);
}

TEST_F(StartingPointsTest, TooFewPhotographsToFindPointsByAreRefused) {
  const std::vector<int> four{0, 6, 12, 18};
  const auto encoded = encode(traced_->capture, four, EncoderSettings{});
  ASSERT_FALSE(encoded);
  EXPECT_EQ(encoded.error().code, Errc::kInvalidInput);
  EXPECT_NE(encoded.error().message.find("from 4 photographs"), std::string::npos);
}

TEST(CheckUnseen, ACloudThatHardlyAnyPhotographShowsIsRefused) {
  std::vector<std::string> warnings;
  EXPECT_TRUE(check_unseen(10, 100, warnings));
  EXPECT_TRUE(warnings.empty());
  EXPECT_TRUE(check_unseen(60, 100, warnings));
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("40 of 100 points"), std::string::npos);
  const auto refused = check_unseen(34'990, 35'000, warnings);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("masks may be inverted"), std::string::npos);
}

TEST_F(StartingPointsTest, AMeshIsTrainedWhereItIsAskedFor) {
  Capture capture = traced_->capture;
  const float side = 0.9f * float(traced_->radius);
  for (int corner = 0; corner < 8; ++corner)
    capture.mesh.vertices.positions.push_back(
        {corner & 1 ? side : -side, corner & 2 ? side : -side, corner & 4 ? side : -side});
  for (const std::array<std::uint32_t, 4>& f : std::vector<std::array<std::uint32_t, 4>>{
           {0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    capture.mesh.triangles.push_back({f[0], f[1], f[2]});
    capture.mesh.triangles.push_back({f[0], f[2], f[3]});
  }
  auto sampled = sample_for_cameras(capture, capture.mesh);
  ASSERT_TRUE(sampled);
  capture.cloud = *std::move(sampled);
  EncoderSettings settings = settings_of(Preset::kDefault, 1);
  settings.surface = Surface::kTrained;
  const auto encoded = encode(capture, traced_->cameras, settings);
  ASSERT_TRUE(encoded) << encoded.error().message;
  EXPECT_EQ(encoded->surface.kept, Surface::kTrained);
}

TEST_F(StartingPointsTest, PointsThatAreAnywhereAreNoSurfaceAsGiven) {
  EncoderSettings settings = settings_of(Preset::kDefault, 1);
  settings.surface = Surface::kGiven;
  const auto encoded = encode(before_stripes(), traced_->cameras, settings);
  ASSERT_FALSE(encoded);
  EXPECT_NE(encoded.error().message.find("--surface trained"), std::string::npos);
}

}  // namespace
}  // namespace slf::starting_points_test
