// SPDX-License-Identifier: Apache-2.0
// Surfaces that photographs train, from points that are far off, few, or wrong.
#include "encoder/train/train_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "capture/nearest.h"
#include "capture/surface_points.h"
#include "encoder/choose_surface.h"
#include "encoder/train/distance_blocks.h"
#include "encoder/train/train_gaussians.h"
#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/gaussian_renderer.h"
#include "tools/synth/synth.h"
#include "traced_scene.h"

namespace slf::train_geometry_test {
namespace {

/// A textured vase in memory, in few and small photographs.
class TrainGeometryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { traced_ = new test::TracedScene("vase", 5, 10, 128, 6000); }
  static void TearDownTestSuite() { delete traced_; }

  static Capture with(const PointCloud& cloud) {
    Capture capture = traced_->capture;
    capture.cloud = cloud;
    return capture;
  }
  /// Every n-th point, without normals: what structure from motion leaves.
  static PointCloud sparse(std::size_t every) {
    PointCloud cloud;
    for (std::size_t p = 0; p < traced_->exact.positions.size(); p += every)
      cloud.positions.push_back(traced_->exact.positions[p]);
    return cloud;
  }
  static PointCloud fat() {
    PointCloud cloud = traced_->exact;
    synth::disturb(cloud, traced_->step, {.hull = 4});
    return cloud;
  }
  /// From the true surface along its normals, in point spacings.
  static std::vector<double> distances(const PointCloud& cloud) {
    const NearestPoints tree(traced_->exact.positions);
    std::vector<double> apart;
    for (const Float3& p : cloud.positions) {
      std::uint32_t nearest = 0;
      tree.nearest(p, 1, &nearest, nullptr);
      apart.push_back(std::abs(double(dot(minus(p, traced_->exact.positions[nearest]),
                                          traced_->exact.normals[nearest])) /
                               traced_->step));
    }
    return apart;
  }
  /// Share of points that are no farther from the true surface than so many point spacings.
  static double share_within(double most, const PointCloud& cloud) {
    const auto apart = distances(cloud);
    return double(std::count_if(apart.begin(), apart.end(), [=](double x) { return x < most; })) /
           double(apart.size());
  }
  static SurfaceReport chosen(const Capture& capture, std::span<const int> cameras,
                              Surface surface = Surface::kAuto) {
    EncoderSettings settings;
    settings.surface = surface;
    SurfaceReport report;
    const auto cloud = choose_surface(capture, cameras, settings, StartId::kPoints, report, {});
    EXPECT_TRUE(cloud) << (cloud ? "" : cloud.error().message);
    return report;
  }

  static inline test::TracedScene* traced_ = nullptr;
};

TEST_F(TrainGeometryTest, AFatCloudComesToTheSurface) {
  const PointCloud cloud = fat();
  const auto trained = train_geometry(with(cloud), traced_->cameras, {.iterations = 1500});
  ASSERT_TRUE(trained);
  ASSERT_GT(trained->cloud.positions.size(), 1000u);
  EXPECT_LT(share_within(1, cloud), 0.25);
  EXPECT_GT(share_within(1, trained->cloud), 0.75);
}

TEST_F(TrainGeometryTest, FewPointsWithoutNormalsBecomeALayer) {
  const PointCloud cloud = sparse(20);
  const auto trained = train_geometry(with(cloud), traced_->cameras, {.iterations = 1500});
  ASSERT_TRUE(trained);
  ASSERT_EQ(trained->cloud.normals.size(), trained->cloud.positions.size());
  EXPECT_GT(trained->cloud.positions.size(), 10 * cloud.positions.size());
  EXPECT_GT(share_within(2, trained->cloud), 0.85);
  const auto voxels = voxelise(trained->cloud, 0, trained->voxel_size);
  ASSERT_TRUE(voxels);
  EXPECT_EQ(voxels->merged, 0u);
}

TEST_F(TrainGeometryTest, TheSameForAnyNumberOfThreads) {
  const Capture capture = with(sparse(20));
  const auto one = train_geometry(capture, traced_->cameras, {.iterations = 60, .threads = 1});
  const auto three = train_geometry(capture, traced_->cameras, {.iterations = 60, .threads = 3});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->cloud.positions, three->cloud.positions);
  EXPECT_EQ(one->cloud.normals, three->cloud.normals);
}

TEST_F(TrainGeometryTest, AnEndedTrainingIsASurfaceStill) {
  const auto trained = train_geometry(with(sparse(20)), traced_->cameras, {.seconds = 0.5});
  ASSERT_TRUE(trained);
  EXPECT_GT(trained->cloud.positions.size(), 1000u);
  EXPECT_GT(share_within(3, trained->cloud), 0.5);
}

TEST_F(TrainGeometryTest, PhotographsThatWouldTakeTooMuchMemoryAreHalved) {
  const double bytes = 50.0 * 128 * 128 * 16;
  const auto whole = train_geometry(with(sparse(20)), traced_->cameras,
                                    {.iterations = 40, .photograph_bytes = bytes});
  const auto any = train_geometry(with(sparse(20)), traced_->cameras, {.iterations = 40});
  const auto halved = train_geometry(with(sparse(20)), traced_->cameras,
                                     {.iterations = 40, .photograph_bytes = 0.9 * bytes});
  ASSERT_TRUE(whole && any && halved);
  EXPECT_EQ(whole->cloud.positions, any->cloud.positions);
  EXPECT_NE(halved->cloud.positions, any->cloud.positions);
}

TEST_F(TrainGeometryTest, AGridThatIsFinerThanPhotographsResolveGetsNoMorePointsThanTheyTell) {
  const Capture capture = with(sparse(20));
  const auto any = train_geometry(capture, traced_->cameras, {.iterations = 40});
  const auto fine = train_geometry(capture, traced_->cameras, {.grid_bits = 18, .iterations = 40});
  ASSERT_TRUE(any && fine);
  EXPECT_LT(fine->voxel_size, 0.01 * any->voxel_size);
  EXPECT_GT(fine->cloud.positions.size(), any->cloud.positions.size() / 2);
  EXPECT_LT(fine->cloud.positions.size(), 8 * any->cloud.positions.size());
}

TEST_F(TrainGeometryTest, SplatsAreTheSameForAnyNumberOfThreads) {
  const Capture capture = with(sparse(20));
  const auto one = train_gaussians(capture, traced_->cameras, {.iterations = 60, .threads = 1});
  const auto three = train_gaussians(capture, traced_->cameras, {.iterations = 60, .threads = 3});
  ASSERT_TRUE(one && three);
  EXPECT_GT(one->size(), 100u);
  EXPECT_EQ(one->positions, three->positions);
  EXPECT_EQ(one->harmonics, three->harmonics);
}

TEST_F(TrainGeometryTest, SplatsOfRoughPointsShowThePhotographs) {
  const Capture capture = with(sparse(20));
  EncoderSettings settings;
  settings.surface = Surface::kSplats;
  const auto coded = encode(capture, traced_->cameras, settings);
  ASSERT_TRUE(coded) << coded.error().message;
  EXPECT_EQ(coded->surface.kept, Surface::kSplats);
  const auto field = decode(coded->stream);
  ASSERT_TRUE(field);
  ASSERT_TRUE(has_gaussians(field->header));
  const Gaussians splats = *gaussians_of(*field);
  const GaussianRenderer renderer(splats, {.background = {0, 0, 0}});
  const Capture judge = with(traced_->exact);
  const auto quality = evaluate_pictures(
      [&](const Camera& camera) { return renderer.render(camera); }, judge, traced_->cameras, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_GT(quality->image.all.psnr, 24);
  EXPECT_GT(quality->image.coverage, 0.97);
}

TEST_F(TrainGeometryTest, SplatsOutsideOfTheOutlinesAreLeftOut) {
  const Float3 on = traced_->exact.positions[0];
  const float size = 3 * float(traced_->step);
  const Vec3 eye = traced_->capture.cameras[0].centre();
  Float3 before{};  // as seen by the first camera, far in front of the object
  for (std::size_t k = 0; k < 3; ++k) before[k] = 0.5f * (on[k] + float(eye[k]));
  TrainedSurfels surfels = {flat_surfel(before, {0, 0, 1}, size, 0.9f),
                            flat_surfel(on, {0, 0, 1}, size, 0.9f)};
  const Capture capture = with(traced_->exact);
  const auto outlines = outlines_of(capture, traced_->cameras, 1);
  ASSERT_TRUE(outlines);
  keep_object(*outlines, 1, surfels);
  ASSERT_EQ(surfels.size(), 1u);
  EXPECT_EQ(surfels[0].position(), on);
}

TEST_F(TrainGeometryTest, SplatsNeedPhotographs) {
  EncoderSettings settings;
  settings.surface = Surface::kSplats;
  const std::span<const int> four(traced_->cameras.data(), 4);
  const auto refused = encode(with(traced_->exact), four, settings);
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("too few cameras"), std::string::npos);
}

TEST_F(TrainGeometryTest, AnExactCloudStaysAndNothingIsTrained) {
  const SurfaceReport report = chosen(with(traced_->exact), traced_->cameras);
  EXPECT_EQ(report.kept, Surface::kGiven);
  EXPECT_EQ(report.surfels, 0u);
  EXPECT_FALSE(report.untrained.empty());
}

TEST_F(TrainGeometryTest, WhatPredictsHeldOutPhotographsIsKept) {
  const SurfaceReport report = chosen(with(sparse(20)), traced_->cameras);
  EXPECT_EQ(report.kept, Surface::kTrained);
  EXPECT_GT(report.trained_psnr, report.before_psnr + 1);
}

/// A mesh that is too fat everywhere, and a sample of it.
TEST_F(TrainGeometryTest, ARoughMeshIsJudgedAsACloudIsAndAnExactOneStays) {
  Capture capture = with(traced_->exact);
  capture.mesh = synth::make_scene("vase")->mesh();
  ASSERT_FALSE(capture.mesh.triangles.empty());
  EXPECT_EQ(chosen(capture, traced_->cameras).kept, Surface::kGiven);
  const auto push = [](PointCloud& cloud, double by) {
    for (std::size_t p = 0; p < cloud.positions.size(); ++p)
      for (std::size_t a = 0; a < 3; ++a) cloud.positions[p][a] += float(by) * cloud.normals[p][a];
  };
  push(capture.mesh.vertices, 4 * traced_->step);
  push(capture.cloud, 4 * traced_->step);
  EncoderSettings settings = settings_of(Preset::kDefault, 1);
  settings.surface = Surface::kAuto;
  settings.q = 16;  // no splats
  const auto coded = encode(capture, traced_->cameras, settings);
  ASSERT_TRUE(coded) << coded.error().message;
  EXPECT_NE(coded->surface.kept, Surface::kGiven);
  const auto field = decode(coded->stream);
  ASSERT_TRUE(field);
  PointCloud cloud;
  for (const Voxel& v : field->positions) {
    const Vec3 at = field->header.grid.world(v);
    cloud.positions.push_back({float(at[0]), float(at[1]), float(at[2])});
  }
  EXPECT_LT(share_within(2, capture.cloud), 0.3);
  EXPECT_GT(share_within(2, cloud), 0.7);
}

TEST_F(TrainGeometryTest, FewCamerasAndFewPointsAreLeftAloneAndSaid) {
  const std::span<const int> one(traced_->cameras.data(), 1), four(traced_->cameras.data(), 4);
  EXPECT_EQ(training_obstacle(with(traced_->exact), one), "too few cameras");
  EXPECT_EQ(training_obstacle(with(traced_->exact), four), "too few cameras");
  EXPECT_EQ(training_obstacle(with(sparse(400)), traced_->cameras), "too few points");
  const SurfaceReport report = chosen(with(fat()), four, Surface::kTrained);
  EXPECT_EQ(report.kept, Surface::kGiven);
  EXPECT_EQ(report.untrained, "too few cameras");
}

/// Photographs of nothing, or of another world than the cameras have it: no worse than before.
TEST_F(TrainGeometryTest, WherePhotographsShowNothingPointsStay) {
  Capture black = with(sparse(6));
  for (Image& image : black.images) std::fill(image.data.begin(), image.data.end(), 0);
  EXPECT_NE(chosen(black, traced_->cameras).kept, Surface::kTrained);
}

/// Distances of a plane z = 3.3 at the nodes of two by two blocks.
TEST(ZeroCrossings, APlaneHasOneLayerOfNodesThatFaceOutwards) {
  DistanceBlocks all;
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 2; ++x) {
      DistanceBlock block;
      block.key = {x, y, 0};
      for (std::size_t i = 0; i < kNodesOfBlock; ++i) {
        block.weight[i] = 2;
        const std::size_t z = i / 64;
        block.distance[i] = 2 * (float(z) - 3.3f);
      }
      all.blocks.push_back(block);
    }
  std::sort(all.blocks.begin(), all.blocks.end(),
            [](const DistanceBlock& a, const DistanceBlock& b) { return a.key < b.key; });
  const SurfacePoints points = zero_crossings(all, 1, 1);
  ASSERT_EQ(points.size(), 256u);
  for (std::size_t p = 0; p < points.size(); ++p) {
    EXPECT_EQ(points.positions[p][2], 3);
    EXPECT_NEAR(points.normals[p][2], 1, 1e-3);
  }
}

TEST(ZeroCrossings, SmallPiecesAreDebris) {
  SurfacePoints points;
  for (int i = 0; i < 30; ++i) points.positions.push_back({float(i), 0, 0});
  for (int i = 0; i < 3; ++i) points.positions.push_back({float(i), 50, 0});
  points.normals.assign(points.positions.size(), {0, 0, 1});
  EXPECT_EQ(without_debris(points, {}, 10).size(), 30u);
  EXPECT_EQ(without_debris(points, {}, 3).size(), 33u);
}

}  // namespace
}  // namespace slf::train_geometry_test
