// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/refine_geometry.h"

#include <gtest/gtest.h>

#include <cmath>

#include "capture/nearest.h"
#include "capture/surface_points.h"
#include "tools/synth/synth.h"
#include "traced_scene.h"

namespace slf::refine_geometry_test {
namespace {

/// A textured vase in memory: what the mending of a cloud is tried on.
class RefineGeometryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { traced_ = new test::TracedScene("vase", 5, 12, 160, 12000); }
  static void TearDownTestSuite() { delete traced_; }

  static Capture with(const PointCloud& cloud) {
    Capture capture = traced_->capture;
    capture.cloud = cloud;
    return capture;
  }
  static Capture disturbed() {
    PointCloud fat = traced_->exact;
    synth::disturb(fat, traced_->step, {.hull = 4});
    return with(fat);
  }
  /// Root mean square distance from the true surface, in point spacings.
  static double distance(const PointCloud& cloud) {
    const NearestPoints tree(traced_->exact.positions);
    double squares = 0;
    for (const Float3& p : cloud.positions) {
      std::uint32_t nearest = 0;
      tree.nearest(p, 1, &nearest, nullptr);
      const double along = double(dot(minus(p, traced_->exact.positions[nearest]),
                                      traced_->exact.normals[nearest])) /
                           traced_->step;
      squares += along * along;
    }
    return std::sqrt(squares / double(cloud.positions.size()));
  }

  static inline test::TracedScene* traced_ = nullptr;
};

TEST_F(RefineGeometryTest, AFatCloudComesCloserToTheSurface) {
  const Capture fat = disturbed();
  const auto refined = refine_geometry(fat, traced_->cameras, {.grid_bits = 7});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kMended);
  EXPECT_GT(refined->report.held_out_after, refined->report.held_out_before + 0.3);
  EXPECT_GT(distance(fat.cloud), 1.5);
  EXPECT_LT(distance(refined->cloud), 0.6 * distance(fat.cloud));
  EXPECT_GT(refined->report.moved, 1000u);
  EXPECT_GT(refined->report.max_move, refined->report.median_move);
}

TEST_F(RefineGeometryTest, AnExactCloudStays) {
  const auto refined = refine_geometry(with(traced_->exact), traced_->cameras, {.grid_bits = 7});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kNoGain);
  EXPECT_TRUE(refined->cloud.positions.empty());
}

TEST_F(RefineGeometryTest, ACloudDenserThanThePhotographsIsMendedAtTheirScaleAndStaysDense) {
  double step = 0;
  PointCloud fat = synth::sample_points(*synth::make_scene("vase"), 60000, 2, &step);
  synth::disturb(fat, step, {.hull = 8});
  const auto refined = refine_geometry(with(fat), traced_->cameras, {.grid_bits = 9});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kMended);
  EXPECT_LT(distance(refined->cloud), 0.6 * distance(fat));
  EXPECT_GT(refined->cloud.positions.size(), 40000u);
  EXPECT_TRUE(refined->report.too_dense_for_grid);
}

TEST_F(RefineGeometryTest, OnAFreeGridACloudDenserThanThePhotographsGetsThePointsThatTheyResolve) {
  double step = 0;
  PointCloud fat = synth::sample_points(*synth::make_scene("vase"), 60000, 2, &step);
  synth::disturb(fat, step, {.hull = 8});
  const double voxel = 0.46 * step;
  const auto refined =
      refine_geometry(with(fat), traced_->cameras, {.voxel_size = voxel, .free_grid = true});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kMended);
  EXPECT_LT(distance(refined->cloud), 0.6 * distance(fat));
  EXPECT_LT(refined->cloud.positions.size(), 54000u);
  EXPECT_FALSE(refined->report.too_dense_for_grid) << "it is thinned";
  ASSERT_GT(refined->voxel_size, voxel);
  const auto voxels = voxelise(refined->cloud, 9, refined->voxel_size);
  ASSERT_TRUE(voxels);
  EXPECT_EQ(voxels->merged, 0u);
}

TEST_F(RefineGeometryTest, ThreadsDoNotChangeTheResult) {
  const Capture fat = disturbed();
  const auto one = refine_geometry(fat, traced_->cameras, {.grid_bits = 7, .threads = 1});
  const auto three = refine_geometry(fat, traced_->cameras, {.grid_bits = 7, .threads = 3});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->cloud.positions, three->cloud.positions);
  EXPECT_EQ(one->cloud.normals, three->cloud.normals);
}

TEST_F(RefineGeometryTest, NoMendedPointsFallIntoOneVoxel) {
  const auto refined = refine_geometry(disturbed(), traced_->cameras, {.grid_bits = 6});
  ASSERT_TRUE(refined);
  ASSERT_GT(refined->voxel_size, 0);
  const auto voxels = voxelise(refined->cloud, 6, refined->voxel_size);
  ASSERT_TRUE(voxels);
  EXPECT_EQ(voxels->merged, 0u);
  EXPECT_LE(voxels->grid.bits, 6);
}

TEST_F(RefineGeometryTest, NothingIsTriedWhenOffOrWithFewCamerasOrPoints) {
  Capture capture = disturbed();
  const auto outcome = [&](std::span<const int> cameras, RefineGeometry mode) {
    const auto refined = refine_geometry(capture, cameras, {.mode = mode});
    return refined ? refined->report.outcome : RefineReport::kMended;
  };
  EXPECT_EQ(outcome(traced_->cameras, RefineGeometry::kOff), RefineReport::kNotAsked);
  EXPECT_EQ(outcome(std::span(traced_->cameras).first(7), RefineGeometry::kOn),
            RefineReport::kTooFewCameras);
  capture.cloud.positions.resize(900);
  EXPECT_EQ(outcome(traced_->cameras, RefineGeometry::kOn), RefineReport::kTooFewPoints);
}

TEST_F(RefineGeometryTest, WhatMendingDoesNotPayForIsLeftAsItIsAndExactPointsAreNotAskedAbout) {
  int asked = 0;
  RefineSettings settings{.grid_bits = 7};
  settings.pays = [&asked]() -> Result<bool, InputError> { return ++asked == 0; };
  const auto rough = refine_geometry(disturbed(), traced_->cameras, settings);
  const auto exact = refine_geometry(with(traced_->exact), traced_->cameras, settings);
  ASSERT_TRUE(rough && exact);
  EXPECT_EQ(rough->report.outcome, RefineReport::kOutdone);
  EXPECT_TRUE(rough->cloud.positions.empty());
  EXPECT_EQ(exact->report.outcome, RefineReport::kNoGain);
  EXPECT_EQ(asked, 1);
}

TEST_F(RefineGeometryTest, ACloudThatNoPhotographShowsIsLeftAlone) {
  PointCloud away = traced_->exact;
  for (Float3& p : away.positions) p[2] += 1000;
  const auto refined = refine_geometry(with(away), traced_->cameras, {.mode = RefineGeometry::kOn});
  if (refined) {
    EXPECT_EQ(refined->report.outcome, RefineReport::kNoGain);
  }
}

TEST_F(RefineGeometryTest, ACloudBesideAllOutlinesIsNotCarvedAway) {
  PointCloud beside = traced_->exact;  // a shell around the object, which no outline reaches
  for (std::size_t p = 0; p < beside.positions.size(); ++p)
    for (std::size_t a = 0; a < 3; ++a)
      beside.positions[p][a] += 40 * float(traced_->step) * beside.normals[p][a];
  const auto refined = refine_geometry(with(beside), traced_->cameras,
                                       {.mode = RefineGeometry::kOn, .grid_bits = 7});
  ASSERT_TRUE(refined);
  if (refined->report.outcome == RefineReport::kMended) {
    EXPECT_LT(distance(refined->cloud), distance(beside));
  }
}

}  // namespace
}  // namespace slf::refine_geometry_test
