// SPDX-License-Identifier: Apache-2.0
// Scenes that move: frames are what they say, of one grid, and the same on any number of threads.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <set>

#include "slf/capture.h"
#include "slf/frame_inputs.h"
#include "tools/synth/moving.h"
#include "tools/synth/moving_cloud.h"
#include "tools/synth/moving_frame.h"
#include "tools/synth/noise.h"
#include "tools/synth/triangle_tree.h"

namespace slf::synth::synth_moving_test {
namespace {

namespace fs = std::filesystem;

class MovingTest : public testing::Test {
 protected:
  MovingTest() {
    std::string name = (fs::temp_directory_path() / "slf_moving_XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~MovingTest() override { fs::remove_all(root_); }

  static MovingSettings small(const std::string& scene, int frames) {
    MovingSettings s;
    s.scene = scene;
    s.frames = frames;
    s.width = s.height = 32;
    return s;
  }
  static MovingSettings small_capture(const std::string& scene, int frames) {
    MovingSettings s = small(scene, frames);
    s.points = 2000;
    s.circles = 1;
    s.per_circle = 4;
    return s;
  }
  static MovingSettings small_cloud(const std::string& scene, int frames) {
    MovingSettings s = small(scene, frames);
    s.bits = 6;
    return s;
  }

  fs::path root_;
};

std::string content_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

using Voxels = std::set<std::array<float, 3>>;

/// Share of the second's voxels that are in the first.
double shared(const PointCloud& first, const PointCloud& second) {
  const Voxels before(first.positions.begin(), first.positions.end());
  std::size_t both = 0;
  for (const auto& voxel : second.positions) both += before.count(voxel);
  return double(both) / double(second.positions.size());
}

TEST_F(MovingTest, CloudsAreWholeNumbersOfTheGridEachVoxelOnce) {
  ASSERT_TRUE(synthesise_moving(small_cloud("noise", 2), root_));
  const auto frames = list_frames(root_);
  ASSERT_TRUE(frames) << frames.error().message;
  EXPECT_EQ(frames->kind, FrameKind::kClouds);
  ASSERT_EQ(frames->frames.size(), 2u);
  for (const FrameInput& frame : frames->frames) {
    const auto cloud = read_ply(frame.path);
    ASSERT_TRUE(cloud) << cloud.error().message;
    EXPECT_EQ(cloud->colours.size(), cloud->positions.size());
    EXPECT_EQ(Voxels(cloud->positions.begin(), cloud->positions.end()).size(),
              cloud->positions.size());
    for (const auto& position : cloud->positions)
      for (const float v : position) {
        EXPECT_EQ(v, std::floor(v));
        EXPECT_GE(v, 0);
        EXPECT_LE(v, 63);
      }
  }
}

TEST_F(MovingTest, FramesResembleEachOtherAsMuchAsTheirNamesSay) {
  const auto share_of = [](const char* name) {
    const auto scene = make_moving_scene(name);
    const FrameGrid grid = frame_grid(*scene, 7);
    const auto samples = material_samples(*scene, 0.4 * grid.step);
    return shared(voxel_frame(*scene, grid, samples, 2, 0),
                  voxel_frame(*scene, grid, samples, 3, 0));
  };
  EXPECT_EQ(share_of("still"), 1);
  const double noise = share_of("noise"), rot1 = share_of("rot1"), rot4 = share_of("rot4");
  EXPECT_GT(noise, 0.8);
  EXPECT_LT(noise, 0.99);
  EXPECT_GT(rot1, 0.6);
  EXPECT_GT(rot1, rot4 + 0.15);
  EXPECT_GT(share_of("tube2"), share_of("tube8") + 0.1);
}

TEST_F(MovingTest, ColoursChangeWithTheLightThatStandsStill) {
  const auto scene = make_moving_scene("rot4");
  const FrameGrid grid = frame_grid(*scene, 6);
  std::vector<MaterialSample> one = material_samples(*scene, 0.1);
  one.resize(1);
  EXPECT_NE(voxel_frame(*scene, grid, one, 0, 1).colours,
            voxel_frame(*scene, grid, one, 6, 1).colours);
}

TEST_F(MovingTest, FilesAreTheSameForAnyThreadCount) {
  for (const std::string scene : {"rot1", "noise", "tube8", "walk"}) {
    MovingSettings s = scene == "walk" ? small_capture(scene, 2) : small_cloud(scene, 2);
    for (const int threads : {1, 4}) {
      s.threads = threads;
      ASSERT_TRUE(synthesise_moving(s, root_ / (scene + std::to_string(threads))));
    }
    const auto entries = {"frame_0002.ply", "frame_0002/points.ply", "frame_0002/images/0002.png"};
    int compared = 0;
    for (const char* file : entries) {
      const std::string one = content_of(root_ / (scene + "1") / file);
      EXPECT_EQ(one, content_of(root_ / (scene + "4") / file)) << scene << file;
      compared += !one.empty();
    }
    EXPECT_EQ(compared, scene == "walk" ? 2 : 1);
  }
}

TEST_F(MovingTest, CapturesHaveTheSameCamerasAndOtherPicturesAndPoints) {
  for (const char* scene : {"turn", "twist", "walk"}) {
    const fs::path place = root_ / scene;
    const auto made = synthesise_moving(small_capture(scene, 2), place);
    ASSERT_TRUE(made) << made.error().message;
    const auto frames = list_frames(place);
    ASSERT_TRUE(frames) << frames.error().message;
    EXPECT_EQ(frames->kind, FrameKind::kCaptures);
    const auto first = load_capture(place / "frame_0001"),
               second = load_capture(place / "frame_0002");
    ASSERT_TRUE(first && second);
    EXPECT_TRUE(first->warnings.empty());
    ASSERT_EQ(first->cameras.size(), 4u);
    EXPECT_EQ(first->splits.at("evaluation"), std::vector<int>{3});
    for (std::size_t i = 0; i < 4; ++i)
      EXPECT_EQ(first->cameras[i].rotation, second->cameras[i].rotation);
    EXPECT_NE(first->cloud.positions, second->cloud.positions);
    EXPECT_NE(load_image(*first, 0)->data, load_image(*second, 0)->data);
  }
}

TEST_F(MovingTest, PhotographsShowThePointsWhereTheyAre) {
  for (const char* name : {"turn", "twist", "walk", "appear"}) {
    auto scene = make_moving_scene(name);
    // White light from everywhere: a photograph shows the colours of the points themselves.
    scene->lamps.clear();
    for (MovingPart& part : scene->parts) part.material = {1, 0, 1, {1, 1, 1}};
    const MovingFrame frame(*scene, 3, 0);
    const auto samples = material_samples(*scene, spacing_of(*scene, 300));
    const PointCloud cloud = moved_cloud(*scene, samples, 3, 0);
    ASSERT_GT(cloud.positions.size(), 150u);
    int close = 0;
    for (std::size_t i = 0; i < cloud.positions.size(); ++i) {
      const auto& [x, y, z] = cloud.positions[i];
      const auto& [nx, ny, nz] = cloud.normals[i];
      const Vec3 at{x, y, z}, normal{nx, ny, nz};
      EXPECT_LT(length(at), scene->radius);
      Colour light{};
      double through = 1;
      ASSERT_TRUE(frame.radiance({at + 0.002 * normal, -1 * normal}, light, through)) << name << i;
      double apart = 0;
      for (std::size_t k = 0; k < 3; ++k)
        apart = std::max(apart, std::abs(255 * srgb_from_linear(light[k]) - cloud.colours[i][k]));
      close += apart < 4;
    }
    // Chords of bent triangles are a little off, and the texture has edges.
    EXPECT_GT(close, 0.9 * double(cloud.positions.size())) << name;
  }
}

TEST_F(MovingTest, AThingAppearsInTheThirdFrame) {
  const auto scene = make_moving_scene("appear");
  const auto samples = material_samples(*scene, spacing_of(*scene, 2000));
  const std::size_t second = moved_cloud(*scene, samples, 1, 1).positions.size();
  const std::size_t third = moved_cloud(*scene, samples, 2, 1).positions.size();
  EXPECT_EQ(moved_cloud(*scene, samples, 0, 1).positions.size(), second);
  EXPECT_GT(third, second + 300);
}

TEST_F(MovingTest, CamerasGoOnByTheAngleAndKeepTheirNames) {
  MovingSettings s = small_capture("turn", 2);
  s.camera_turn = 90;
  ASSERT_TRUE(synthesise_moving(s, root_));
  ASSERT_TRUE(list_frames(root_));
  const auto first = load_capture(root_ / "frame_0001"),
             second = load_capture(root_ / "frame_0002");
  ASSERT_TRUE(first && second);
  for (std::size_t k = 0; k < 3; ++k)  // four on a circle: each is where the next was
    EXPECT_NEAR(second->cameras[0].centre()[k], first->cameras[1].centre()[k], 1e-9);
}

TEST_F(MovingTest, AnEarlierSceneIsReplacedAndAForeignDirectoryKept) {
  ASSERT_TRUE(synthesise_moving(small_cloud("tube2", 3), root_ / "ours"));
  ASSERT_TRUE(synthesise_moving(small_capture("turn", 1), root_ / "ours"));
  EXPECT_FALSE(fs::exists(root_ / "ours" / "frame_0003.ply"));
  EXPECT_TRUE(list_frames(root_ / "ours"));
  fs::create_directory(root_ / "foreign");
  std::ofstream(root_ / "foreign" / "frame_0001.ply") << "mine";
  const auto refused = synthesise_moving(small_cloud("tube2", 1), root_ / "foreign");
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kUnwritable);
  EXPECT_EQ(content_of(root_ / "foreign" / "frame_0001.ply"), "mine");
}

TEST_F(MovingTest, SettingsOutOfRangeAreNamed) {
  const auto message = [&](const MovingSettings& s) {
    const auto result = synthesise_moving(s, root_ / "none");
    return result ? std::string("accepted") : result.error().message;
  };
  EXPECT_EQ(message(small("can", 2)),
            "scene can is none of those that move: " + moving_scene_names());
  EXPECT_EQ(message(small("rot1", 0)), "frames 0 is outside 1 .. 9999");
  MovingSettings s = small("rot1", 1);
  s.bits = 13;
  EXPECT_EQ(message(s), "bits 13 is outside 5 .. 12");
  s = small("rot1", 1);
  s.points = 1000;
  EXPECT_EQ(message(s), "rot1 is a cloud on a grid of --bits: it has no --points, no cameras");
  s = small("turn", 1);
  s.bits = 8;
  EXPECT_EQ(message(s), "turn is a capture: it has --points, bits are of clouds");
  s.bits = 0;
  s.camera_turn = std::nan("");
  EXPECT_EQ(message(s), "camera turn: -180 to 180 degrees");
  EXPECT_FALSE(fs::exists(root_ / "none"));
}

TEST(TriangleTreeTest, TheNearestIsThatOfAllTrianglesOneByOne) {
  std::uint32_t drawn = 0;
  const auto vector = [&drawn] {
    Vec3 v;
    for (double& x : v) x = 2 * unit(5, drawn++) - 1;
    return v;
  };
  std::vector<TriangleTree::Corners> triangles;
  for (int i = 0; i < 300; ++i) {
    const Vec3 at = vector();
    triangles.push_back({at, at + 0.3 * vector(), at + 0.3 * vector()});
  }
  const TriangleTree tree(triangles);
  int hits = 0;
  for (int i = 0; i < 500; ++i) {
    const Vec3 from = 3 * vector();
    const Ray ray{from, normalised(vector() - from)};
    std::optional<std::uint32_t> expected;
    double nearest = 1e9;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
      const auto one = TriangleTree({triangles[t]}).nearest(ray);
      if (!one || one->t >= nearest) continue;
      nearest = one->t;
      expected = t;
    }
    const auto hit = tree.nearest(ray);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (!hit) continue;
    EXPECT_EQ(hit->triangle, *expected);
    EXPECT_EQ(hit->t, nearest);
    ++hits;
  }
  EXPECT_GT(hits, 50);
}

}  // namespace
}  // namespace slf::synth::synth_moving_test
