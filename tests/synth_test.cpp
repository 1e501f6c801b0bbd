#include "tools/synth/synth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>

#include "slf/capture.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/trace.h"

namespace slf::synth {
namespace {

namespace fs = std::filesystem;

/// A directory of its own, removed at the end.
class SynthTest : public testing::Test {
 protected:
  SynthTest() {
    std::string name = (fs::temp_directory_path() / "slf_synth_XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~SynthTest() override { fs::remove_all(root_); }

  static SynthSettings small(const std::string& scene) {
    SynthSettings settings;
    settings.scene = scene;
    settings.width = 40;
    settings.height = 32;
    settings.points = 2000;
    settings.circles = 3;
    settings.per_circle = 4;
    return settings;
  }

  fs::path root_;
};

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST(RingsTest, SplitsAreThePapersAndEvaluationIsHeldOutOfAllOfThem) {
  const Rings rings = make_rings(11, 50, 256, 256, 0.9);
  EXPECT_EQ(rings.splits.at("dense").size(), 125u);
  EXPECT_EQ(rings.splits.at("intermediate").size(), 39u);
  EXPECT_EQ(rings.splits.at("sparse").size(), 14u);
  EXPECT_EQ(rings.splits.at("evaluation").size(), 100u);
  std::set<int> input;
  for (const char* split : {"dense", "intermediate", "sparse"})
    input.insert(rings.splits.at(split).begin(), rings.splits.at(split).end());
  for (const int camera : rings.splits.at("evaluation")) EXPECT_EQ(input.count(camera), 0u);
  for (const int camera : rings.splits.at("dense")) {
    EXPECT_EQ(rings.circle[std::size_t(camera)] % 2, 1);
    EXPECT_EQ(rings.index[std::size_t(camera)] % 2, 0);
  }
  // Every camera is in some split, and numbered after its place.
  EXPECT_EQ(rings.cameras.size(), input.size() + 100);
  for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
    const std::string number = std::to_string(10000 + 50 * rings.circle[i] + rings.index[i] + 1);
    EXPECT_EQ(rings.cameras[i].name, "images/" + number.substr(1) + ".png");
  }
}

TEST(RingsTest, CamerasLieOnTheSphereAndLookAtTheOriginUpright) {
  const Rings rings = make_rings(11, 50, 320, 240, 0.9);
  for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
    const Camera& camera = rings.cameras[i];
    const Vec3 centre = camera.centre();
    EXPECT_NEAR(length(centre), 5, 1e-12);
    EXPECT_NEAR(centre[2], 5 * (-0.85 + 0.17 * rings.circle[i]), 1e-12);
    const auto middle = camera.project({0, 0, 0});
    ASSERT_TRUE(middle);
    EXPECT_NEAR((*middle)[0], 160, 1e-9);
    EXPECT_NEAR((*middle)[1], 120, 1e-9);
    const auto above = camera.project({0, 0, 0.1});  // image y points down
    EXPECT_LT((*above)[1], 120);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(dot(camera.rotation[std::size_t(k)], camera.rotation[std::size_t((k + 1) % 3)]),
                  0, 1e-12);
    EXPECT_NEAR(dot(cross(camera.rotation[0], camera.rotation[1]), camera.rotation[2]), 1, 1e-12);
  }
}

class SceneTest : public testing::TestWithParam<const char*> {};

TEST_P(SceneTest, NormalsAreUnitPerpendicularToTheSurfaceAndOutward) {
  const auto scene = make_scene(GetParam());
  const PointCloud cloud = sample_points(*scene, 3000, 2);
  ASSERT_GT(cloud.positions.size(), 2000u);
  ASSERT_LT(cloud.positions.size(), 4500u);
  int inside_out = 0;
  for (std::size_t p = 0; p < cloud.positions.size(); ++p) {
    const auto& at = cloud.positions[p];
    const auto& m = cloud.normals[p];
    const Vec3 position{at[0], at[1], at[2]}, n{m[0], m[1], m[2]};
    ASSERT_NEAR(length(n), 1, 1e-5);
    // A ray from far outside along -n enters here: as many crossings lie before as leave the body.
    const Ray ray{position + 10 * n, -1 * n};
    std::vector<SurfacePoint> crossings;
    scene->crossings(ray, crossings);
    int before = 0;
    for (const auto& c : crossings) before += dot(c.position - ray.origin, ray.direction) < 9.99;
    inside_out += before % 2;
  }
  // A crossing within 0.01 of the point counts wrongly at thin rims.
  EXPECT_LT(inside_out, static_cast<int>(cloud.positions.size() / 50));
}

TEST_P(SceneTest, TheCloudIsTheSameForAnyThreadCountAndLiesWithinBounds) {
  const auto scene = make_scene(GetParam());
  const PointCloud one = sample_points(*scene, 3000, 1), seven = sample_points(*scene, 3000, 7);
  EXPECT_EQ(one.positions, seven.positions);
  EXPECT_EQ(one.normals, seven.normals);
  EXPECT_EQ(one.colours, seven.colours);
  for (const auto& p : one.positions)
    ASSERT_LE(length({p[0], p[1], p[2]}), scene->bounds().radius + 1e-6);
}

TEST_P(SceneTest, PhotographsShowThePointsOfTheCloudInFrontOfGrey128) {
  const auto scene = make_scene(GetParam());
  const Camera camera = make_rings(3, 4, 64, 64, scene->bounds().radius).cameras[5];
  const Image image = trace_image(*scene, camera, 2);
  const PointCloud cloud = sample_points(*scene, 20000, 2);
  std::vector<bool> shown(64 * 64);
  for (const auto& p : cloud.positions) {
    const auto at = camera.project({p[0], p[1], p[2]});
    ASSERT_TRUE(at);
    ASSERT_TRUE((*at)[0] > 0 && (*at)[0] < 64 && (*at)[1] > 0 && (*at)[1] < 64);
    shown[std::size_t((*at)[1]) * 64 + std::size_t((*at)[0])] = true;
  }
  int object = 0, background = 0, wrong = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const bool grey =
        image.data[3 * i] == 128 && image.data[3 * i + 1] == 128 && image.data[3 * i + 2] == 128;
    object += shown[i];
    background += !shown[i];
    wrong += grey == shown[i];
  }
  EXPECT_GT(object, 400);
  EXPECT_GT(background, 400);
  EXPECT_LT(wrong, 60);  // pixels of the outline that only a sample or only a point touches
}

INSTANTIATE_TEST_SUITE_P(Scenes, SceneTest, testing::Values("can", "die", "vase"),
                         [](const auto& scene) { return std::string(scene.param); });

TEST(SamplePointsTest, TheDefaultCanIsClosedOnAnEightBitGridWithHardlyAnyDuplicates) {
  const auto scene = make_scene("can");
  const PointCloud cloud = sample_points(*scene, 0, 2);
  EXPECT_GT(cloud.positions.size(), 80000u);
  EXPECT_LT(cloud.positions.size(), 100000u);
  const auto voxels = voxelise(cloud, 8);
  ASSERT_TRUE(voxels);
  EXPECT_LT(voxels->merged, cloud.positions.size() / 100);
  // Closed: what is reached from a corner through faces of empty voxels does not reach the middle.
  std::vector<std::uint8_t> state(256 * 256 * 256);
  const auto at = [](int x, int y, int z) { return std::size_t((z * 256 + y) * 256 + x); };
  for (const Voxel& v : voxels->positions) state[at(v[0], v[1], v[2])] = 1;
  // The can fills the middle of no face of the grid but its own extent in x and y.
  std::vector<std::array<int, 3>> open{{255, 255, 255}};
  state[at(255, 255, 255)] = 2;
  while (!open.empty()) {
    const auto [x, y, z] = open.back();
    open.pop_back();
    for (const auto& d :
         {Voxel{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const int nx = x + d[0], ny = y + d[1], nz = z + d[2];
      if (nx < 0 || ny < 0 || nz < 0 || nx > 255 || ny > 255 || nz > 255) continue;
      if (state[at(nx, ny, nz)] != 0) continue;
      state[at(nx, ny, nz)] = 2;
      open.push_back({nx, ny, nz});
    }
  }
  const auto middle = voxels->grid;
  const auto index = [&](std::size_t k) {
    return int(std::lround(-middle.origin[k] / middle.step));
  };
  EXPECT_EQ(state[at(index(0), index(1), index(2))], 0);
}

TEST_F(SynthTest, ACaptureIsReadBackAsItWasMade) {
  for (const char* scene : {"can", "die", "vase"}) {
    const fs::path directory = root_ / scene;
    const auto made = synthesise(small(scene), directory);
    ASSERT_TRUE(made) << made.error().message;
    const auto capture = load_capture(directory);
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_TRUE(capture->warnings.empty());
    EXPECT_EQ(capture->cloud.normals.size(), capture->cloud.positions.size());
    EXPECT_EQ(capture->cloud.colours.size(), capture->cloud.positions.size());
    const Rings rings = make_rings(3, 4, 40, 32, make_scene(scene)->bounds().radius);
    ASSERT_EQ(capture->cameras.size(), rings.cameras.size());
    EXPECT_EQ(capture->splits, rings.splits);
    for (std::size_t i = 0; i < rings.cameras.size(); ++i) {
      EXPECT_EQ(capture->cameras[i].rotation, rings.cameras[i].rotation);
      EXPECT_EQ(capture->cameras[i].fx, rings.cameras[i].fx);
    }
    const auto image = load_image(*capture, 0);
    ASSERT_TRUE(image) << image.error().message;
    EXPECT_EQ(image->data, trace_image(*make_scene(scene), rings.cameras[0], 2).data);
  }
}

TEST_F(SynthTest, FilesAreTheSameForAnyThreadCount) {
  SynthSettings settings = small("can");
  for (const int threads : {1, 3}) {
    settings.threads = threads;
    ASSERT_TRUE(synthesise(settings, root_ / std::to_string(threads)));
  }
  for (const char* file : {"points.ply", "cameras.json", "images/0005.png"}) {
    ASSERT_FALSE(bytes_of(root_ / "1" / file).empty()) << file;
    EXPECT_EQ(bytes_of(root_ / "1" / file), bytes_of(root_ / "3" / file)) << file;
  }
}

TEST_F(SynthTest, AForeignDirectoryIsKeptAndACaptureOfOursReplaced) {
  const fs::path foreign = root_ / "foreign";
  fs::create_directory(foreign);
  std::ofstream(foreign / "thesis.txt") << "mine";
  const auto refused = synthesise(small("can"), foreign);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kUnwritable);
  EXPECT_NE(refused.error().message.find("foreign"), std::string::npos);
  EXPECT_FALSE(fs::exists(foreign / "cameras.json"));

  SynthSettings forced = small("can");
  forced.force = true;
  ASSERT_TRUE(synthesise(forced, foreign));
  EXPECT_EQ(bytes_of(foreign / "thesis.txt"), "mine");

  ASSERT_TRUE(synthesise(small("die"), root_ / "ours"));
  std::ofstream(root_ / "ours" / "images" / "stale.png") << "old";
  ASSERT_TRUE(synthesise(small("can"), root_ / "ours"));
  EXPECT_FALSE(fs::exists(root_ / "ours" / "images" / "stale.png"));
}

TEST_F(SynthTest, SettingsOutOfRangeAreNamed) {
  const auto message = [&](const SynthSettings& settings) {
    const auto result = synthesise(settings, root_ / "none");
    EXPECT_FALSE(result);
    if (result) return std::string();
    EXPECT_EQ(result.error().code, Errc::kInvalidArgument);
    return result.error().message;
  };
  SynthSettings settings = small("bunny");
  EXPECT_EQ(message(settings), "scene bunny is none of can, die, vase");
  settings = small("can");
  settings.width = 4097;
  EXPECT_EQ(message(settings), "width 4097 is outside 8 .. 4096");
  settings = small("can");
  settings.points = 99;
  EXPECT_EQ(message(settings), "points 99 is outside 100 .. 10000000");
  settings = small("can");
  settings.supersampling = 0;
  EXPECT_EQ(message(settings), "supersampling 0 is outside 1 .. 8");
  EXPECT_FALSE(fs::exists(root_ / "none"));
}

TEST(DisturbTest, NoiseHasTheDeviationAskedForAndTheSameSeedGivesTheSameCloud) {
  double step = 0;
  const PointCloud exact = sample_points(*make_scene("die"), 5000, 1, &step);
  for (const double scale : {0.0, 8.0}) {
    PointCloud one = exact, two = exact;
    disturb(one, step, {.noise = 0.5, .noise_scale = scale});
    disturb(two, step, {.noise = 0.5, .noise_scale = scale});
    EXPECT_EQ(one.positions, two.positions);
    EXPECT_TRUE(one.normals.empty());
    double squares = 0;
    for (std::size_t p = 0; p < exact.positions.size(); ++p)
      for (std::size_t a = 0; a < 3; ++a) {
        const double moved = double(one.positions[p][a]) - double(exact.positions[p][a]);
        squares += moved * moved;
      }
    // 5000 samples: 1 % off, one deviation; smooth noise has a few hundred that are independent.
    EXPECT_NEAR(std::sqrt(squares / double(exact.positions.size())) / step, 0.5,
                scale > 0 ? 0.1 : 0.03);
  }
}

TEST(DisturbTest, AHullIsOutsideOfTheSurfaceAndWithinTheAmount) {
  double step = 0;
  const PointCloud exact = sample_points(*make_scene("vase"), 5000, 1, &step);
  PointCloud hull = exact;
  disturb(hull, step, {.hull = 3});
  double least = 9, most = -9;
  for (std::size_t p = 0; p < exact.positions.size(); ++p) {
    double out = 0;
    for (std::size_t a = 0; a < 3; ++a)
      out += (double(hull.positions[p][a]) - double(exact.positions[p][a])) *
             double(exact.normals[p][a]) / step;
    least = std::min(least, out);
    most = std::max(most, out);
  }
  EXPECT_GE(least, -1e-3);
  EXPECT_LE(most, 3 + 1e-3);
  EXPECT_LT(least, 1.2);
  EXPECT_GT(most, 1.8);
}

TEST_F(SynthTest, ADisturbedCaptureHasTheTrueCloudBesideIt) {
  SynthSettings settings = small("can");
  settings.disturb.hull = 2;
  ASSERT_TRUE(synthesise(settings, root_));
  const auto exact = read_ply(root_ / "exact.ply"), hull = read_ply(root_ / "points.ply");
  ASSERT_TRUE(exact && hull);
  EXPECT_EQ(exact->positions.size(), hull->positions.size());
  EXPECT_NE(exact->positions, hull->positions);
  settings.disturb = {};
  ASSERT_TRUE(synthesise(settings, root_));
  EXPECT_FALSE(fs::exists(root_ / "exact.ply"));
  settings.disturb.noise = -1;
  EXPECT_FALSE(synthesise(settings, root_));
}

}  // namespace
}  // namespace slf::synth
