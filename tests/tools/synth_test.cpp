// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/synth.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "slf/capture.h"
#include "tools/synth/rings.h"
#include "tools/synth/sample_points.h"
#include "tools/synth/scene.h"
#include "tools/synth/trace.h"

namespace slf::synth::synth_test {
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

TEST(SynthRings, HaveSplitsThatAFitCanUseHoweverFewTheyAre) {
  for (const int circles : {1, 3, 4, 5, 11})
    for (const int per_circle : {4, 8, 14, 50}) {
      const Rings rings = make_rings(circles, per_circle, 40, 32, 1);
      const auto& dense = rings.splits.at("dense");
      const auto& evaluation = rings.splits.at("evaluation");
      EXPECT_GE(6 * dense.size(), rings.cameras.size()) << circles << " x " << per_circle;
      EXPECT_GE(evaluation.size(), rings.cameras.size() / 8) << circles << " x " << per_circle;
      for (const int camera : evaluation)
        EXPECT_EQ(std::count(dense.begin(), dense.end(), camera), 0);
      if (const auto other = rings.splits.find("intermediate"); other != rings.splits.end()) {
        EXPECT_LT(other->second.size(), rings.cameras.size());
      }
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
  EXPECT_EQ(message(settings),
            "scene bunny is none of can, die, vase, terrace, nor of those that move (slf synth "
            "--list)");
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
}  // namespace slf::synth::synth_test
