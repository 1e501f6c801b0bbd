// SPDX-License-Identifier: Apache-2.0
// Streets of houses: points on surfaces, cameras that see them, and files that are always the same.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>

#include "slf/capture.h"
#include "tools/synth/synth.h"
#include "tools/synth/terrace.h"
#include "tools/synth/terrace_points.h"
#include "tools/synth/terrace_views.h"
#include "tools/synth/trace.h"

namespace slf::synth::synth_terrace_test {
namespace {

namespace fs = std::filesystem;

PointCloud sampled(const Terrace& terrace, double step, int threads) {
  PointCloud all;
  sample_terrace(terrace, step, threads, [&](const PointCloud& piece, double) {
    all.positions.insert(all.positions.end(), piece.positions.begin(), piece.positions.end());
    all.normals.insert(all.normals.end(), piece.normals.begin(), piece.normals.end());
    all.colours.insert(all.colours.end(), piece.colours.begin(), piece.colours.end());
  });
  return all;
}

Vec3 to_vec(const std::array<float, 3>& v) { return {double{v[0]}, double{v[1]}, double{v[2]}}; }

TEST(SolidTest, ChordsAgreeWithContainment) {
  const Vec3 low{-1, -1, -1}, high{1, 1, 1};
  for (const Shape shape : {Shape::kBox, Shape::kSphere, Shape::kCylinder, Shape::kRoof}) {
    const Solid solid{low, high, shape};
    int met = 0;
    for (int i = 0; i < 500; ++i) {
      const Vec3 from{4 * std::cos(i * 2.4), 4 * std::sin(i * 2.4), 3 * std::sin(i * 0.7)};
      const Vec3 aim{0.9 * std::sin(i * 1.1), 0.9 * std::sin(i * 1.7), 0.9 * std::sin(i * 0.3)};
      const Ray ray{from, normalised(aim - from)};
      const auto c = chord(solid, Probe(ray));
      bool inside = false;
      for (double t = 0; t < 10; t += 0.01) {
        const bool here = contains(solid, ray.at(t));
        inside |= here;
        if (c && std::abs(t - c->enter) > 0.01 && std::abs(t - c->leave) > 0.01) {
          ASSERT_EQ(here, t > c->enter && t < c->leave) << i << " at " << t;
        }
      }
      if (!c) {
        ASSERT_FALSE(inside);
        continue;
      }
      ++met;
      EXPECT_NEAR(length(c->enter_normal), 1, 1e-9);
      EXPECT_LT(dot(c->enter_normal, ray.direction), 0);
      EXPECT_GT(dot(c->leave_normal, ray.direction), 0);
    }
    EXPECT_GT(met, 200);
  }
}

TEST(SolidTreeTest, FindsWhatLookingAtEverySolidFinds) {
  const Terrace terrace(4, 3);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 from{20 * std::sin(i * 0.37), 2.5 * std::sin(i * 1.3), 30 + 5 * std::sin(i * 2.1)};
    const Ray ray{from, normalised({std::sin(i * 0.9), std::cos(i * 1.9), -0.9})};
    double nearest = 1e30;
    const Probe probe(ray);
    for (const Solid& solid : terrace.tree().solids())
      if (const auto c = chord(solid, probe); c && c->enter > 0)
        nearest = std::min(nearest, c->enter);
    const auto hit = terrace.tree().nearest(ray);
    ASSERT_EQ(hit.has_value(), nearest < 1e29);
    ASSERT_EQ(terrace.tree().blocked(ray), nearest < 1e29);
    ASSERT_DOUBLE_EQ(hit ? hit->t : 1e30, nearest);
  }
}

TEST(TerracePlanTest, HousesAreAsManyAsAskedAndNoTwoOverlap) {
  for (const int houses : {1, 2, 3, 12, 37, 500, 10'000}) {
    const Plan plan = make_plan(houses, 1);
    EXPECT_EQ(plan.lots.size(), std::size_t(houses));
    for (std::size_t i = 0; i < plan.lots.size(); ++i) {
      EXPECT_GT(plan.lots[i].x1 - plan.lots[i].x0, 4);
      const bool beside = i > 0 && std::abs(plan.lots[i].front - plan.lots[i - 1].front) < 1;
      EXPECT_GE(plan.lots[i].x0, beside ? plan.lots[i - 1].x1 - 1e-9 : -plan.length);
    }
    EXPECT_LT(plan.low_x() / plan.low_y(), 2.5);
  }
}

TEST(TerracePointsTest, AreAboutAsManyAsAskedForAnyNumberOfHouses) {
  for (const int houses : {1, 12, 150})
    for (const int points : {2'000, 60'000, 400'000}) {
      const Terrace terrace(houses, 1);
      const PointCloud cloud = sampled(terrace, terrace_step(terrace, points, 2), 2);
      EXPECT_NEAR(double(cloud.positions.size()) / points, 1, 0.2) << houses << " " << points;
    }
}

TEST(TerracePointsTest, LieOnWhatIsSeenWithTheNormalOfTheSurface) {
  const Terrace terrace(5, 2);
  const PointCloud cloud = sampled(terrace, terrace_step(terrace, 20'000, 2), 2);
  std::size_t off = 0;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    const Vec3 at = to_vec(cloud.positions[p]), n = to_vec(cloud.normals[p]);
    ASSERT_NEAR(length(n), 1, 1e-5);
    // Floats of the ground's very rim may be outside of it.
    if (at[0] < terrace.plan().low_x() + 1e-4 || at[1] < terrace.plan().low_y() + 1e-4) continue;
    // From just above the point along -n the first surface is the point's own.
    const auto hit = terrace.tree().nearest({at + 5e-4 * n, -1 * n});
    off += !hit || std::abs(hit->t - 5e-4) > 1e-4 || dot(hit->point.normal, n) < 0.999;
  }
  EXPECT_LT(off, cloud.positions.size() / 500);  // floats, on the very edge of a solid
}

TEST(TerracePointsTest, AGridOfTheStepHasOneLayerWithoutHoles) {
  const Terrace terrace(2, 1);
  const double step = terrace_step(terrace, 150'000, 2);
  const PointCloud cloud = sampled(terrace, step, 2);
  const auto voxels = voxelise(cloud, 0, step);
  ASSERT_TRUE(voxels);
  EXPECT_LT(voxels->merged, cloud.positions.size() / 20);
  // From above there is no way down anywhere.
  std::size_t closed = 0, columns = 0;
  std::set<std::pair<int, int>> covered;
  for (const Voxel& v : voxels->positions) covered.insert({int(v[0]), int(v[1])});
  const auto most_x = int(-2 * terrace.plan().low_x() / step),
             most_y = int(-2 * terrace.plan().low_y() / step);
  for (int x = 0; x < most_x; ++x)
    for (int y = 0; y < most_y; ++y) {
      ++columns;
      closed += covered.count({x, y});
    }
  EXPECT_EQ(closed, columns);
}

TEST(TerracePointsTest, AreTheSameForAnyThreadCountAndOtherForAnotherSeed) {
  const Terrace terrace(3, 1), again(3, 1), other(3, 2);
  const double step = terrace_step(terrace, 30'000, 1);
  EXPECT_EQ(step, terrace_step(again, 30'000, 3));
  const PointCloud one = sampled(terrace, step, 1), three = sampled(again, step, 3);
  EXPECT_EQ(one.positions, three.positions);
  EXPECT_EQ(one.normals, three.normals);
  EXPECT_EQ(one.colours, three.colours);
  EXPECT_NE(one.positions, sampled(other, step, 1).positions);
}

TEST(TerraceViewsTest, SplitsAreDisjointAndEveryEighthIsHeldOut) {
  for (const int cameras : {2, 9, 200}) {
    const Rings views = make_terrace_views(make_plan(12, 1), cameras, 64, 48);
    ASSERT_EQ(views.cameras.size(), std::size_t(cameras));
    const auto& dense = views.splits.at("dense");
    std::set<int> all(dense.begin(), dense.end());
    for (const int camera : views.splits.at("evaluation")) EXPECT_TRUE(all.insert(camera).second);
    EXPECT_EQ(all.size(), std::size_t(cameras));
    EXPECT_EQ(views.splits.at("evaluation").size(),
              std::size_t((cameras + 3) / 8 + (cameras == 2)));
    for (const char* split : {"intermediate", "sparse"})
      for (const int camera : views.splits.at(split))
        EXPECT_EQ(std::count(dense.begin(), dense.end(), camera), 1);
  }
}

TEST(TerraceViewsTest, EveryCameraIsInTheOpenAndSeesPartAndMostPointsAreSeenBySeveral) {
  for (const int houses : {1, 12, 60}) {
    const Terrace terrace(houses, 1);
    const PointCloud cloud = sampled(terrace, terrace_step(terrace, 4'000, 2), 2);
    const Rings views = make_terrace_views(terrace.plan(), 160, 80, 60);
    std::vector<int> seen(cloud.positions.size());
    for (const Camera& camera : views.cameras) {
      ASSERT_FALSE(terrace.tree().inside(camera.centre()));
      std::size_t here = 0;
      for (std::size_t p = 0; p < seen.size(); ++p) {
        const Vec3 at = to_vec(cloud.positions[p]) + 1e-3 * to_vec(cloud.normals[p]);
        const auto pixel = camera.project(at);
        if (!pixel || (*pixel)[0] < 0 || (*pixel)[0] > 80 || (*pixel)[1] < 0 || (*pixel)[1] > 60)
          continue;
        const Vec3 way = camera.centre() - at;
        const auto hit = terrace.tree().nearest({at, normalised(way)});
        if (hit && hit->t < length(way)) continue;
        ++seen[p];
        ++here;
      }
      EXPECT_GT(here, seen.size() / 1000) << camera.name;
      EXPECT_LT(here, 3 * seen.size() / 4) << camera.name;
    }
    const auto several = std::count_if(seen.begin(), seen.end(), [](int n) { return n >= 3; });
    EXPECT_GT(double(several) / double(seen.size()), 0.6) << houses;
  }
}

TEST(TerraceTest, WindowsLookDifferentFromElsewhereAndPlasterDoesNot) {
  const Terrace terrace(12, 1);
  int windows = 0, changed = 0;
  for (const Solid& solid : terrace.tree().solids()) {
    if (solid.surface != Surface::kWindow && solid.surface != Surface::kPlaster) continue;
    const bool pane = solid.surface == Surface::kWindow;
    const Vec3 at{0.7 * solid.low[0] + 0.3 * solid.high[0], solid.high[1],
                  0.7 * solid.low[2] + 0.3 * solid.high[2]};
    std::vector<Colour> lights;
    for (const double aside : {-3.0, 0.5, 3.0}) {
      const Vec3 eye = at + Vec3{aside, 4, -1};
      const Ray ray{eye, normalised(at - eye)};
      const auto hit = terrace.tree().nearest(ray);
      if (!hit || hit->solid != &solid || hit->point.normal[1] < 0.5) continue;
      double transmittance = 1;
      EXPECT_TRUE(terrace.radiance(ray, lights.emplace_back(), transmittance));
      EXPECT_EQ(transmittance, 0);
    }
    if (lights.size() < 2) continue;
    const double change = length(lights.front() - lights.back());
    EXPECT_TRUE(pane || change < 0.02);  // what the distance blurs
    windows += pane;
    changed += pane && change > 0.02;
  }
  EXPECT_GT(windows, 20);
  EXPECT_GT(changed, windows / 2);
}

class TerraceCaptureTest : public testing::Test {
 protected:
  TerraceCaptureTest() {
    std::string name = (fs::temp_directory_path() / "slf_terrace_XXXXXX").string();
    root_ = mkdtemp(name.data());
    small_.scene = "terrace";
    small_.width = 40;
    small_.height = 30;
    small_.points = 3000;
    small_.cameras = 9;
    small_.houses = 3;
  }
  ~TerraceCaptureTest() override { fs::remove_all(root_); }

  fs::path root_;
  SynthSettings small_;
};

TEST_F(TerraceCaptureTest, IsReadBackAndTheSameForAnyThreadCount) {
  for (const int threads : {1, 3}) {
    small_.threads = threads;
    const auto made = synthesise(small_, root_ / std::to_string(threads));
    ASSERT_TRUE(made) << made.error().message;
  }
  const auto one = load_capture(root_ / "1"), three = load_capture(root_ / "3");
  ASSERT_TRUE(one && three) << one.error().message;
  EXPECT_TRUE(one->warnings.empty());
  EXPECT_EQ(one->cloud.positions, three->cloud.positions);
  EXPECT_EQ(one->cloud.colours, three->cloud.colours);
  EXPECT_EQ(one->cloud.normals.size(), one->cloud.positions.size());
  ASSERT_EQ(one->cameras.size(), 9u);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(load_image(*one, i)->data, load_image(*three, i)->data);
  for (const auto& entry : fs::recursive_directory_iterator(root_))
    EXPECT_EQ(entry.path().string().find(".tmp"), std::string::npos);
}

TEST_F(TerraceCaptureTest, ADisturbedCloudHasTheTrueOneBesideIt) {
  small_.disturb.noise = 0.5;
  ASSERT_TRUE(synthesise(small_, root_));
  const auto exact = read_ply(root_ / "exact.ply"), noisy = read_ply(root_ / "points.ply");
  ASSERT_TRUE(exact && noisy);
  EXPECT_EQ(exact->positions.size(), noisy->positions.size());
  EXPECT_NE(exact->positions, noisy->positions);
}

TEST_F(TerraceCaptureTest, SettingsOutOfRangeAreNamed) {
  const auto message = [&](const SynthSettings& settings) {
    const auto result = synthesise(settings, root_ / "none");
    return result ? std::string() : result.error().message;
  };
  SynthSettings s = small_;
  s.houses = 10'001;
  EXPECT_EQ(message(s), "houses 10001 is outside 1 .. 10000");
  s = small_;
  s.cameras = 1;
  EXPECT_EQ(message(s), "cameras 1 is outside 2 .. 10000");
  s = small_;
  s.points = 100'000'001;
  EXPECT_EQ(message(s), "points 100000001 is outside 100 .. 100000000");
  s = small_;
  s.mesh = true;
  EXPECT_EQ(message(s), "the terrace has no mesh; can and vase have one");
  s = small_;
  s.scene = "can";
  EXPECT_EQ(message(s), "houses and cameras are of the terrace; can, die and vase have circles");
  EXPECT_FALSE(fs::exists(root_ / "none"));
}

}  // namespace
}  // namespace slf::synth::synth_terrace_test
