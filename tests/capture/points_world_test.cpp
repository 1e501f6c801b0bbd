// SPDX-License-Identifier: Apache-2.0
// Clouds in another world than the cameras': noticed, with what brings them together.
#include "slf/points_world.h"

#include <gmock/gmock.h>

#include "capture/change_world.h"
#include "capture_support.h"
#include "tools/synth/synth.h"

namespace slf::points_world_test {
namespace {

using test::TemporaryDirectory;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

WorldChange parsed(const std::string& text) {
  const auto change = parse_world_change(text);
  EXPECT_TRUE(change) << text;
  return change ? *change : WorldChange{};
}

TEST(PointsWorld, TextsOfChangesAreReadAsTheyAreWritten) {
  for (const char* text : {"x,y,z", "-y,x,-z", "z,x,y,0.001", "x,-z,y,1,0.5,0,-2"})
    EXPECT_EQ(text_of(parsed(text)), text);
  for (const char* text : {"", "x,y", "x,x,z", "x,y,w", "x,y,z,0", "x,y,z,-1", "x,y,z,nan",
                           "x,y,z,1,2", "x,y,z,1,2,3,4,5", "--x,y,z", "x,y,z,1e999"})
    EXPECT_FALSE(parse_world_change(text)) << text;
}

TEST(PointsWorld, AMirrorKeepsTheOutsideOfFaces) {
  EXPECT_FALSE(parsed("x,-z,y").mirrors());
  EXPECT_FALSE(parsed("y,z,x").mirrors());
  EXPECT_TRUE(parsed("x,z,y").mirrors());
  EXPECT_TRUE(parsed("x,y,-z").mirrors());
  Mesh mesh{{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {}, {1, 2, 3}}, {{0, 1, 2}}};
  change_world(parsed("-x,y,z,2,0,0,1"), mesh);
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
  EXPECT_EQ(mesh.vertices.positions[1], (std::array<float, 3>{-2, 0, 0}));
  EXPECT_EQ(mesh.vertices.origin, (Vec3{-2, 4, 7}));
}

/// A capture whose cloud was moved; photographs stay where they are.
class OtherWorldTest : public testing::Test {
 protected:
  void make(const char* scene, const synth::DisturbSettings& disturb = {}, double drift = 0) {
    synth::SynthSettings settings;
    settings.scene = scene;
    settings.width = settings.height = 96;
    settings.points = 4000;
    settings.circles = 5;
    settings.per_circle = 8;
    settings.supersampling = 1;
    settings.disturb = disturb;
    settings.exposure_drift = drift;
    const auto made = synth::synthesise(settings, root_.path());
    ASSERT_TRUE(made) << made.error().message;
  }

  /// What is said of the cloud after a change that nobody asked for.
  std::vector<std::string> warnings(const std::string& change, const std::string& asked = "") {
    auto cloud = read_ply(root_ / "points.ply");
    EXPECT_TRUE(cloud);
    Mesh mesh{*cloud, {}};
    change_world(parsed(change), mesh);
    EXPECT_TRUE(write_ply(root_ / "other.ply", mesh.vertices));
    CaptureOptions options;
    options.points = root_ / "other.ply";
    if (!asked.empty()) options.world = parsed(asked);
    const auto capture = load_capture(root_.path(), options);
    if (!capture) return {capture.error().message};
    return capture->warnings;
  }

  /// The option that a warning names.
  static std::string advice(const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings)
      if (const auto at = warning.find("--points-world="); at != warning.npos) {
        const std::string rest = warning.substr(at + 15);
        return rest.substr(0, rest.find(' '));
      }
    return {};
  }

  TemporaryDirectory root_;
};

constexpr const char* kAnother = "another world than the cameras";

TEST_F(OtherWorldTest, IsNoticedAndItsAdviceMendsIt) {
  make("vase");
  for (const char* change :
       {"x,z,y", "x,-z,y", "x,y,-z", "x,y,z,1000", "x,y,z,0.001", "x,y,z,1,3,0,0", "x,z,-y,1000",
        "y,z,x,2.5,1,-2,0.5", "x,y,z,100,40,0,0"}) {
    const auto said = warnings(change);
    EXPECT_THAT(said, Contains(HasSubstr(kAnother))) << change;
    const std::string advised = advice(said);
    ASSERT_NE(advised, "") << change;
    EXPECT_THAT(warnings(change, advised), Not(Contains(HasSubstr("world"))))
        << change << " " << advised;
  }
}

TEST_F(OtherWorldTest, SaysInWordsWhatIsExchanged) {
  make("vase");
  EXPECT_THAT(warnings("x,-z,y"),
              Contains(AllOf(HasSubstr("y and z are exchanged"), HasSubstr("x,z,-y"))));
  EXPECT_THAT(warnings("x,y,z,1000"),
              Contains(AllOf(HasSubstr("units are others"), HasSubstr("x,y,z,0.001"))));
}

TEST_F(OtherWorldTest, IsNotSeenInSoundCaptures) {
  for (const char* scene : {"can", "die", "vase"}) {
    make(scene);
    EXPECT_THAT(warnings("x,y,z"), IsEmpty()) << scene;
    make(scene, {}, 0.3);
    EXPECT_THAT(warnings("x,y,z"), IsEmpty()) << scene << ", exposures drift";
    synth::DisturbSettings hull;
    hull.hull = 4;
    make(scene, hull);
    EXPECT_THAT(warnings("x,y,z"), Not(Contains(HasSubstr("world")))) << scene << ", hull";
    synth::DisturbSettings noise;
    noise.noise = 2;
    make(scene, noise);
    EXPECT_THAT(warnings("x,y,z"), Not(Contains(HasSubstr("world")))) << scene << ", noise";
  }
}

TEST_F(OtherWorldTest, WhatLooksTheSameFromEverySideIsNone) {
  make("vase");
  EXPECT_THAT(warnings("-y,x,z"), Not(Contains(HasSubstr("world"))));
}

}  // namespace
}  // namespace slf::points_world_test
