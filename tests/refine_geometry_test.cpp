#include "refine/refine_geometry.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "capture/nearest.h"
#include "capture/resample.h"
#include "capture/spacing.h"
#include "lightfield/observe_depth.h"
#include "refine/offset_field.h"
#include "refine/regions.h"
#include "refine/shine_through.h"
#include "refine/silhouettes.h"
#include "tests/capture_support.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/synth.h"
#include "tools/synth/trace.h"

namespace slf {
namespace {

/// A sphere of radius 1 by the golden spiral, normals exact.
SurfacePoints sphere(std::size_t count) {
  SurfacePoints points;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = 1 - (2 * double(i) + 1) / double(count), r = std::sqrt(1 - z * z);
    const double turn = std::numbers::pi * (3 - std::sqrt(5.0)) * double(i);
    const Float3 n{float(r * std::cos(turn)), float(r * std::sin(turn)), float(z)};
    points.positions.push_back(n);
    points.normals.push_back(n);
    points.source.push_back(std::uint32_t(i));
  }
  return points;
}

double radius(const Float3& p) { return std::sqrt(double(dot(p, p))); }

TEST(SurfacePointsTest, ASphereIsItsOwnNeighboursSurface) {
  const SurfacePoints points = sphere(4000);
  const Neighbours near = find_neighbours(points, 12, 0.08, 2);
  for (const float distance : distance_to_neighbours(points, near, 2))
    EXPECT_NEAR(distance, 0, 1e-4);
  const auto normals = plane_normals(points, near, 2);
  // The spiral is not symmetric about a point: planes lean by a little of a spacing (0.056).
  for (std::size_t p = 0; p < points.size(); ++p)
    EXPECT_GT(dot(normals[p], points.normals[p]), 0.995f);
}

TEST(ResampleTest, PointsAreOnTheSurfaceAndCloseSmallHolesAndDropDuplicates) {
  SurfacePoints points = sphere(8000);
  const double spacing = typical_spacing(points.positions);
  SurfacePoints holed;
  for (std::size_t p = 0; p < points.size(); ++p)
    for (int copies = p % 7 == 0 ? 0 : 2; copies > 0; --copies) {
      holed.positions.push_back(points.positions[p]);
      holed.normals.push_back(points.normals[p]);
      holed.source.push_back(std::uint32_t(p));
    }
  const Lattice lattice{{-1.1, -1.1, -1.1}, spacing, {}};
  const SurfacePoints whole = resample(points, lattice, {}), mended = resample(holed, lattice, {});
  for (const Float3& p : mended.positions) EXPECT_NEAR(radius(p), 1, 0.1 * spacing);
  EXPECT_NEAR(double(mended.size()), double(whole.size()), 0.03 * double(whole.size()));
  for (const std::uint32_t source : mended.source) EXPECT_NE(source % 7, 0u);
}

TEST(ResampleTest, OnTheLatticePointsAreNodesWithinItsSize) {
  const SurfacePoints points = sphere(2000);
  ResampleSettings settings;
  settings.on_lattice = true;
  const Lattice lattice{{-1, -1, -1}, 0.125, {17, 17, 9}};
  const SurfacePoints nodes = resample(points, lattice, settings);
  ASSERT_GT(nodes.size(), 100u);
  for (const Float3& p : nodes.positions)
    for (std::size_t a = 0; a < 3; ++a) {
      const float node = (p[a] + 1) / 0.125f;
      EXPECT_FLOAT_EQ(node, std::round(node));
      EXPECT_LE(node, a == 2 ? 8 : 16);
      EXPECT_GE(node, 0);
    }
}

class OffsetFieldTest : public testing::Test {
 protected:
  static constexpr OffsetRange kRange{-0.04, 0.01, 9};
  const SurfacePoints points_ = sphere(2000);
  const Neighbours near_ = find_neighbours(points_, 12, 0.1, 2);

  std::vector<float> costs_at(std::size_t label) const {
    std::vector<float> costs(points_.size() * kRange.count);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const double apart = double(i % kRange.count) - double(label);
      costs[i] = float(std::min(0.1 * apart * apart, 1.0));
    }
    return costs;
  }
};

TEST_F(OffsetFieldTest, TheCheapestOffsetIsTaken) {
  for (const float offset : choose_offsets(costs_at(6), kRange, near_, {}))
    EXPECT_NEAR(offset, 0.02, 1e-3);
}

TEST_F(OffsetFieldTest, NothingMovesWhereAllOffsetsCostTheSame) {
  const std::vector<float> flat(points_.size() * kRange.count, 0.7f);
  for (const float offset : choose_offsets(flat, kRange, near_, {})) EXPECT_NEAR(offset, 0, 1e-6);
}

TEST_F(OffsetFieldTest, APointThatDisagreesFollowsItsNeighbours) {
  std::vector<float> costs = costs_at(6);
  for (std::size_t l = 0; l < kRange.count; ++l) costs[100 * kRange.count + l] = l == 0 ? 0 : 1;
  EXPECT_NEAR(choose_offsets(costs, kRange, near_, {})[100], 0.02, 0.01);
}

TEST(RegionsTest, PointsStayWhereErrorsGrowAndMoveWhereTheyFall) {
  const SurfacePoints before = sphere(3000);
  SurfacePoints after = before;
  move_along_normals(after, std::vector<float>(after.size(), -0.05f));
  HeldOutErrors old_errors{std::vector<float>(3000, 10), std::vector<float>(3000, 1), {}};
  HeldOutErrors new_errors = old_errors;
  for (std::size_t p = 0; p < 3000; ++p)
    new_errors.squares[p] = before.positions[p][2] > 0 ? 5.0f : 20.0f;
  const HeldOutErrors none{std::vector<float>(3000, 0), std::vector<float>(3000, 0), {}};
  const auto worse = worse_after(before, old_errors, after, new_errors, none, 0.1);
  const SurfacePoints both = with_kept(before, after, worse);
  ASSERT_EQ(both.size(), 3000u);
  for (const Float3& p : both.positions) {
    if (p[2] > 0.25f) {
      EXPECT_NEAR(radius(p), 0.95, 1e-4);
    }
    if (p[2] < -0.25f) {
      EXPECT_NEAR(radius(p), 1, 1e-4);
    }
  }
}

TEST(RegionsTest, MovedPointsThatNoCameraSeesAreDroppedAndOthersStay) {
  const SurfacePoints before = sphere(1000);
  SurfacePoints after = before;
  std::vector<float> inwards(1000, 0);
  std::fill(inwards.begin(), inwards.begin() + 500, -0.2f);
  move_along_normals(after, inwards);
  std::vector<std::uint8_t> seen(1000, 1);
  std::fill(seen.begin(), seen.begin() + 100, 0);  // moved
  std::fill(seen.begin() + 900, seen.end(), 0);    // not moved
  const SurfacePoints left = without_unsupported(before, after, seen, 0.1);
  ASSERT_EQ(left.size(), 900u);
  EXPECT_EQ(left.source.front(), 100u);
  EXPECT_EQ(left.source.back(), 999u);
}

TEST(ShineThroughTest, AHoleInTheObjectIsFoundAndASmallerOutlineIsNot) {
  const SurfacePoints before = sphere(6000);
  Capture capture;
  Camera camera;  // looks along +z from z = -5
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 400;
  camera.cx = camera.cy = 100;
  camera.translation = {0, 0, 5};
  capture.cameras.push_back(camera);
  SurfacePoints smaller = before, torn;
  for (Float3& p : smaller.positions)
    for (float& x : p) x *= 0.97f;
  for (std::size_t p = 0; p < before.size(); ++p) {
    const Float3& at = before.positions[p];
    if (at[0] * at[0] + at[1] * at[1] < 0.05f) continue;  // through and through
    torn.positions.push_back(at);
    torn.normals.push_back(before.normals[p]);
    torn.source.push_back(std::uint32_t(p));
  }
  const double spacing = typical_spacing(before.positions);
  const auto none = shines_through(capture, std::vector<int>{0}, before, smaller, spacing, 2);
  EXPECT_EQ(std::count(none.begin(), none.end(), 1), 0);
  const auto hole = shines_through(capture, std::vector<int>{0}, before, torn, spacing, 2);
  EXPECT_GT(std::count(hole.begin(), hole.end(), 1), 20);
  for (std::size_t p = 0; p < before.size(); ++p)
    if (hole[p] != 0) {
      EXPECT_LT(std::hypot(before.positions[p][0], before.positions[p][1]), 0.6);
    }
}

/// A sphere before plain grey, seen from z = -5, with the disc that its photograph shows.
Capture photographed_sphere() {
  Capture capture;
  Camera camera;
  camera.width = camera.height = 200;
  camera.fx = camera.fy = 400;
  camera.cx = camera.cy = 100;
  camera.translation = {0, 0, 5};
  capture.cameras.push_back(camera);
  Image image{200, 200, 3, {}};
  const double disc = 400 / std::sqrt(24.0);
  for (int y = 0; y < 200; ++y)
    for (int x = 0; x < 200; ++x)
      for (int c = 0; c < 3; ++c)
        image.data.push_back(std::hypot(x - 99.5, y - 99.5) < disc ? 200 : 100);
  capture.images.push_back(image);
  return capture;
}

class SilhouetteTest : public testing::Test {
 protected:
  SilhouetteTest() {
    silhouettes_ = *load_silhouettes(capture_, std::vector<int>{0}, sphere_, spacing_, 2);
  }
  SurfacePoints of_radius(double radius) const {
    SurfacePoints points = sphere_;
    for (Float3& p : points.positions)
      for (float& x : p) x *= float(radius);
    return points;
  }

  const SurfacePoints sphere_ = sphere(6000);
  const double spacing_ = typical_spacing(sphere_.positions);
  const Capture capture_ = photographed_sphere();
  std::vector<Silhouette> silhouettes_;
};

TEST_F(SilhouetteTest, WhatIsUncoveredCountsAsTheBackgroundThatShowsInItsPlace) {
  SurfacePoints torn;
  for (std::size_t p = 0; p < sphere_.size(); ++p) {
    const Float3& at = sphere_.positions[p];
    if (at[0] * at[0] + at[1] * at[1] < 0.09f) continue;  // through and through
    torn.positions.push_back(at);
    torn.normals.push_back(sphere_.normals[p]);
    torn.source.push_back(std::uint32_t(p));
  }
  const HeldOutErrors errors = uncovered_errors(silhouettes_, sphere_, torn, spacing_, 2);
  EXPECT_NEAR(errors.mean(), 100 * 100, 1);
  std::size_t counted = 0;
  for (std::size_t p = 0; p < sphere_.size(); ++p)
    if (errors.views[p] > 0) {
      ++counted;
      EXPECT_LT(std::hypot(sphere_.positions[p][0], sphere_.positions[p][1]), 0.3);
      EXPECT_LT(sphere_.positions[p][2], 0);  // the side that the camera sees
    }
  EXPECT_GT(counted, 50u);
}

TEST_F(SilhouetteTest, ASmallerOutlineUncoversNothingUntilItIsAPointSpacingSmaller) {
  EXPECT_EQ(uncovered_errors(silhouettes_, sphere_, of_radius(1 - spacing_), spacing_, 2).mean(),
            0);
  EXPECT_GT(
      uncovered_errors(silhouettes_, sphere_, of_radius(1 - 5 * spacing_), spacing_, 2).mean(), 0);
}

TEST_F(SilhouetteTest, OutlinesGoWhereThePhotographHasThem) {
  const double pixel = std::sqrt(24.0) / 400;  // at the outline
  for (const double radius : {1.0, 1.08}) {
    const SurfacePoints points = of_radius(radius);
    const auto limits = outline_limits(silhouettes_, points, spacing_, 2);
    std::size_t limited = 0;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (limits[p].most > 1) continue;
      ++limited;
      EXPECT_LE(limits[p].least, limits[p].most);
      EXPECT_GE(limits[p].least, 1 - radius - 2 * pixel);
      EXPECT_LE(limits[p].most, 1 - radius + spacing_ + 2 * pixel);
      // Seen from a finite distance the outline is a little before the middle.
      EXPECT_NEAR(points.positions[p][2] / radius, -0.2, 0.25);
    }
    EXPECT_GT(limited, 100u) << radius;
    EXPECT_LT(limited, 2500u) << radius;
  }
}

TEST_F(SilhouetteTest, BeforeAMotleyBackgroundNothingIsSaid) {
  Capture capture = capture_;
  for (std::size_t i = 0; i < capture.images[0].data.size(); ++i)
    if (capture.images[0].data[i] == 100) capture.images[0].data[i] = std::uint8_t(i * 37);
  const auto motley = load_silhouettes(capture, std::vector<int>{0}, sphere_, spacing_, 2);
  ASSERT_TRUE(motley);
  for (const OffsetLimits& limits : outline_limits(*motley, sphere_, spacing_, 2))
    EXPECT_GT(limits.most, 1e30f);
  EXPECT_EQ(uncovered_errors(*motley, sphere_, of_radius(0.5), spacing_, 2).mean(), 0);
}

/// A textured vase in memory: what the mending of a cloud is tried on.
class RefineGeometryTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const auto scene = synth::make_scene("vase");
    const auto rings = synth::make_rings(5, 12, 160, 160, scene->bounds().radius);
    capture_ = new Capture;
    capture_->cameras = rings.cameras;
    for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
      capture_->images.push_back(synth::trace_image(*scene, rings.cameras[i], 2));
      cameras_.push_back(int(i));
    }
    exact_ = new PointCloud(synth::sample_points(*scene, 12000, 2, &step_));
  }
  static void TearDownTestSuite() {
    delete capture_;
    delete exact_;
  }

  static Capture with(const PointCloud& cloud) {
    Capture capture = *capture_;
    capture.cloud = cloud;
    return capture;
  }
  static Capture disturbed() {
    PointCloud fat = *exact_;
    synth::disturb(fat, step_, {.hull = 4});
    return with(fat);
  }
  /// Root mean square distance from the true surface, in point spacings.
  static double distance(const PointCloud& cloud) {
    const NearestPoints tree(exact_->positions);
    double squares = 0;
    for (const Float3& p : cloud.positions) {
      std::uint32_t nearest = 0;
      tree.nearest(p, 1, &nearest, nullptr);
      const double along =
          double(dot(minus(p, exact_->positions[nearest]), exact_->normals[nearest])) / step_;
      squares += along * along;
    }
    return std::sqrt(squares / double(cloud.positions.size()));
  }

  static inline Capture* capture_ = nullptr;
  static inline PointCloud* exact_ = nullptr;
  static inline std::vector<int> cameras_;
  static inline double step_ = 0;
};

TEST_F(RefineGeometryTest, AFatCloudComesCloserToTheSurface) {
  const Capture fat = disturbed();
  const auto refined = refine_geometry(fat, cameras_, {.grid_bits = 7});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kMended);
  EXPECT_GT(refined->report.held_out_after, refined->report.held_out_before + 0.3);
  EXPECT_GT(distance(fat.cloud), 1.5);
  EXPECT_LT(distance(refined->cloud), 0.6 * distance(fat.cloud));
  EXPECT_GT(refined->report.moved, 1000u);
  EXPECT_GT(refined->report.max_move, refined->report.median_move);
}

TEST_F(RefineGeometryTest, AnExactCloudStays) {
  const auto refined = refine_geometry(with(*exact_), cameras_, {.grid_bits = 7});
  ASSERT_TRUE(refined);
  EXPECT_EQ(refined->report.outcome, RefineReport::kNoGain);
  EXPECT_TRUE(refined->cloud.positions.empty());
}

TEST_F(RefineGeometryTest, ThreadsDoNotChangeTheResult) {
  const Capture fat = disturbed();
  const auto one = refine_geometry(fat, cameras_, {.grid_bits = 7, .threads = 1});
  const auto three = refine_geometry(fat, cameras_, {.grid_bits = 7, .threads = 3});
  ASSERT_TRUE(one && three);
  EXPECT_EQ(one->cloud.positions, three->cloud.positions);
  EXPECT_EQ(one->cloud.normals, three->cloud.normals);
}

TEST_F(RefineGeometryTest, OfMendedPointsNoneFallIntoOneVoxel) {
  const auto refined = refine_geometry(disturbed(), cameras_, {.grid_bits = 6});
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
  EXPECT_EQ(outcome(cameras_, RefineGeometry::kOff), RefineReport::kNotAsked);
  EXPECT_EQ(outcome(std::span(cameras_).first(7), RefineGeometry::kOn),
            RefineReport::kTooFewCameras);
  capture.cloud.positions.resize(900);
  EXPECT_EQ(outcome(cameras_, RefineGeometry::kOn), RefineReport::kTooFewPoints);
}

TEST_F(RefineGeometryTest, ACloudThatNoPhotographShowsIsLeftAlone) {
  PointCloud away = *exact_;
  for (Float3& p : away.positions) p[2] += 1000;
  const auto refined = refine_geometry(with(away), cameras_, {.mode = RefineGeometry::kOn});
  if (refined) {
    EXPECT_EQ(refined->report.outcome, RefineReport::kNoGain);
  }
}

/// A translucent, glossy die: the photographs agree best where its mirror images are, far inside.
class RefineDieTest : public testing::TestWithParam<synth::DisturbSettings> {};

TEST_P(RefineDieTest, WhatPhotographsShowStaysCovered) {
  const auto scene = synth::make_scene("die");
  const auto rings = synth::make_rings(5, 12, 120, 120, scene->bounds().radius);
  Capture capture;
  std::vector<int> cameras;
  for (const Camera& camera : rings.cameras) {
    cameras.push_back(int(cameras.size()));
    capture.cameras.push_back(camera);
    capture.images.push_back(synth::trace_image(*scene, camera, 2));
  }
  double step = 0;
  const PointCloud exact = synth::sample_points(*scene, 20000, 2, &step);
  capture.cloud = exact;
  synth::disturb(capture.cloud, step, GetParam());
  const auto refined =
      refine_geometry(capture, cameras, {.mode = RefineGeometry::kOn, .grid_bits = 8});
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
                         [](const auto& instance) {
                           return instance.param.hull > 0 ? "hull" : "noise";
                         });

}  // namespace
}  // namespace slf
