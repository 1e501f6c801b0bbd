// SPDX-License-Identifier: Apache-2.0
// Clouds of views as frames in time through the program: coded, measured, cut, written again.
#include "cli_support.h"
#include "slf/plenoptic.h"

namespace slf::cli_plenoptic_frames_test {
namespace {

constexpr int kFrames = 4, kViews = 4;

class PlenopticFramesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    for (int f = 0; f < kFrames; ++f) write(file(f), cloud(f));
  }
  static std::string file(int f) { return "s_" + std::to_string(f) + ".ply"; }
  /// A sheet that moves along x, seen from four sides.
  static std::string cloud(int f, int views = kViews, int points = 400, double scale = 1) {
    std::string out = "ply\nformat ascii 1.0\n";
    for (int v = 0; v < views; ++v)
      out += "comment view " + std::to_string(v) + (v < 2 ? " 90 " : " -50 ") +
             (v % 2 == 0 ? "80" : "-60") + " 70\n";
    out += "element vertex " + std::to_string(points) + "\n";
    for (const char* axis : {"x", "y", "z"}) out += std::string("property float ") + axis + "\n";
    for (const char* own : {"red", "green", "blue"})
      out += std::string("property uchar ") + own + "\n";
    for (int v = 0; v < views; ++v)
      for (const char* channel : {"r", "g", "b"})
        out += std::string("property uchar ") + channel + std::to_string(v) + "\n";
    out += "end_header\n";
    for (int i = 0; i < points; ++i) {
      const int x = i % 20, y = i / 20, z = (x * x + y) / 16;
      for (const int at : {x + f, y, z}) out += std::to_string(scale * at) + " ";
      for (int c = 0; c < 3 + 3 * views; ++c)
        out += std::to_string(40 + 8 * x + (c * y) % 40 + (i * 7 + c) % 3) + " ";
      out += "\n";
    }
    return out;
  }
  PlenopticCloud read_cloud(const std::string& name) const {
    const auto cloud = read_plenoptic(path(name), {});
    EXPECT_TRUE(cloud) << cloud.error().message;
    return cloud ? *cloud : PlenopticCloud{};
  }
};

TEST_F(PlenopticFramesTest, FilmsWithOtherNamesOfViewsAreNotJoined) {
  ASSERT_EQ(slf("encode s_%d.ply --frames 0:1 -o a.slf --quiet").code, 0);
  const Ran same = slf("merge --append a.slf a.slf -o m.slf --quiet");
  EXPECT_EQ(same.code, 0) << same.err;
  for (int f = 0; f < 2; ++f) {
    std::string renamed = cloud(f);
    for (std::size_t at = renamed.find(" r1\n"); at != renamed.npos; at = renamed.find(" r1\n"))
      renamed.replace(at, 4, " q1\n");
    write("n_" + std::to_string(f) + ".ply", renamed);
  }
  ASSERT_EQ(slf("encode n_%d.ply -o n.slf --quiet").code, 0);
  expect_failure(slf("merge --append a.slf n.slf -o n2.slf"), 4, "n.slf", "views are not those");
  EXPECT_FALSE(exists("n2.slf"));
}

TEST_F(PlenopticFramesTest, ComeBackExactWithTheirProperties) {
  const Ran coded = slf("encode s_%d.ply -o x.slf --group 3 --rate 10 --json");
  ASSERT_EQ(coded.code, 0) << coded.err;
  const auto report = parsed(coded.out);
  EXPECT_EQ(report["as"], "planes");
  EXPECT_EQ(report["exact"], true);
  EXPECT_EQ(report["frames"][1]["predicted"], true);
  EXPECT_EQ(report["frames"][3]["predicted"], false);
  const Ran decoded = slf("decode x.slf --frames 0:3 -o d_%d.ply --quiet");
  ASSERT_EQ(decoded.code, 0) << decoded.err;
  EXPECT_EQ(decoded.err, "");
  for (int f = 0; f < kFrames; ++f) {
    const PlenopticCloud given = read_cloud(file(f)),
                         back = read_cloud("d_" + std::to_string(f) + ".ply");
    EXPECT_EQ(back.positions, given.positions);
    EXPECT_EQ(back.colours, given.colours);
    EXPECT_EQ(back.properties, given.properties);
    EXPECT_EQ(back.view_positions, given.view_positions);
  }
  const auto info = parsed(slf("info x.slf --json").out);
  EXPECT_EQ(info["frames"].size(), 4u);
  EXPECT_EQ(slf("decode x.slf --frame 2 --levels 3 -o few.ply --quiet").code, 0);
}

TEST_F(PlenopticFramesTest, AreMeasuredEachAndOnTheMean) {
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf -q 8 --quiet").code, 0);
  const Ran ran = slf("eval x.slf s_%d.ply --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto report = parsed(ran.out);
  ASSERT_EQ(report["frames"].size(), 4u);
  double sum = 0, bytes = 0;
  for (const auto& frame : report["frames"]) {
    EXPECT_GT(frame["coded"]["mean"][0], 35);
    sum += frame["coded"]["mean"][0].get<double>() / kFrames;
    bytes += frame["bytes"].get<double>();
  }
  EXPECT_NEAR(report["coded"]["mean"][0], sum, 1e-9);
  EXPECT_EQ(report["bytes"], read("x.slf").size());
  EXPECT_EQ(bytes, double(read("x.slf").size()));
  EXPECT_NEAR(report["bits_per_point"], 8 * bytes / 1600, 1e-9);
  const auto one = parsed(slf("eval x.slf --frame 2 s_2.ply --json").out);
  EXPECT_EQ(one["coded"]["mean"], report["frames"][2]["coded"]["mean"]);
  EXPECT_NE(slf("eval x.slf s_%d.ply").out.find("mean over frames"), std::string::npos);
  expect_failure(slf("eval x.slf s_%d.ply --frames 0:1"), 2, "x.slf", "has 4 frames");
  expect_failure(slf("eval x.slf s_%d.ply --min-psnr 30"), 2, "--min-psnr", "clouds of views");
  write("o_0.ply", cloud(7));
  expect_failure(slf("eval x.slf --frame 0 o_0.ply"), 4, "o_0.ply", "other points");
}

TEST_F(PlenopticFramesTest, ThatAreCutOrMergedAreThoseOfTheWhole) {
  for (const std::string step : {"", "-q 6 "}) {
    ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet --group 2 " + step).code, 0);
    for (const char* part : {"1", "2"})
      ASSERT_EQ(slf("encode s_%d.ply --group 2 --quiet " + step + "--part " + part + "/2 -o p" +
                    part + ".slf")
                    .code,
                0);
    ASSERT_EQ(slf("merge p2.slf p1.slf -o m.slf --quiet").code, 0);
    EXPECT_EQ(read("m.slf"), read("x.slf"));
    ASSERT_EQ(slf("truncate x.slf --frames 2:3 -o cut.slf --quiet").code, 0);
    ASSERT_EQ(slf("decode x.slf --frame 3 -o a.ply --quiet").code, 0);
    ASSERT_EQ(slf("decode cut.slf --frame 1 -o b.ply --quiet").code, 0);
    EXPECT_EQ(read("a.ply"), read("b.ply"));
  }
}

TEST_F(PlenopticFramesTest, MayBeEmptyAndADryRunSaysWhatWouldBeDone) {
  write(file(1), cloud(0, kViews, 0));
  const auto plan = parsed(slf("encode s_%d.ply -o x.slf --dry-run --json").out);
  EXPECT_EQ(plan["kind"], "clouds of views");
  EXPECT_EQ(plan["frames"][1]["points"], 0);
  EXPECT_EQ(plan["frames"][2]["predicted"], false);
  EXPECT_FALSE(exists("x.slf"));
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet").code, 0);
  ASSERT_EQ(slf("decode x.slf --frames 0:3 -o d_%d.ply --quiet").code, 0);
  EXPECT_NE(read("d_1.ply").find("element vertex 0\n"), std::string::npos);
  EXPECT_NE(read("d_1.ply").find("property uchar b3\n"), std::string::npos);
  EXPECT_EQ(parsed(slf("eval x.slf s_%d.ply --json").out)["coded"]["exact"], true);
}

TEST_F(PlenopticFramesTest, WithOtherViewsAreRefusedByFile) {
  const auto refused = [&](const std::string& text, const std::string& what) {
    write(file(2), text);
    expect_failure(slf("encode s_%d.ply -o x.slf --quiet"), 4, "s_2.ply", what);
    EXPECT_FALSE(exists("x.slf"));
  };
  refused(cloud(2, 3), "3 views");
  std::string other = cloud(2);
  other.replace(other.find("uchar r1"), 8, "uchar q1");
  refused(other, "uchar q1");
  refused(cloud(2, 0), "no views");
  refused(cloud(2, kViews, 400, 0.25), "not whole numbers");
  other = cloud(2);
  other.replace(other.find("view 0 90"), 9, "view 0 91");
  refused(other, "--views");
}

TEST_F(PlenopticFramesTest, OptionsTheyDoNotHaveAreRefusedByNameAndTheOthersAct) {
  write("v.json", "[[90,80,70],[91,-60,70],[-50,80,70],[-50,-60,70]]");
  for (const std::string option : {"--points x.ply",
                                   "--images d",
                                   "--split all",
                                   "--refit-still",
                                   "--crop 0,0,0,9,9,9",
                                   "--up +x",
                                   "--crs site.prj",
                                   "--memory 300M",
                                   "--work w",
                                   "--degree 2",
                                   "--steps uniform",
                                   "--colour none",
                                   "--chroma-step 2",
                                   "--grid-bits 9",
                                   "--voxel-size 2",
                                   "--normal-bits 6",
                                   "--linear",
                                   "--delta 60",
                                   "--effort 3",
                                   "--surface splats",
                                   "--target-bytes 3000",
                                   "--match-exposure off",
                                   "--hold-out 1 --as planes"}) {
    const Ran ran = slf("encode s_%d.ply -o y.slf " + option);
    expect_failure(ran, 2, option.substr(0, option.find(' ')), "");
    EXPECT_FALSE(exists("y.slf")) << option;
  }
  const auto acts = [&](const std::string& base, const std::string& option) {
    ASSERT_EQ(slf("encode s_%d.ply -o plain.slf --quiet " + base).code, 0) << base;
    const Ran ran = slf("encode s_%d.ply -o y.slf --quiet " + base + " " + option);
    ASSERT_EQ(ran.code, 0) << option << ran.err;
    EXPECT_TRUE(read("y.slf") != read("plain.slf")) << base << " " << option;
  };
  for (const std::string option :
       {"--as viewmaps", "--hold-out 1", "--as colour", "--views v.json", "--metadata who=me",
        "--frames 0:2", "--group 1", "--rate 10", "-q 4", "--metres-per-unit 2",
        "--target-bitrate 400000", "--klt off", "--predict off", "--reference-contexts off",
        "--part 1/2 --group 1"})
    acts("", option);
  acts("-q 8", "--rdo 0.7");
  for (const std::string option :
       {"--degree 1", "--steps uniform", "--colour none", "--chroma-step 2", "--views v.json",
        "--directions world", "--basis bspline", "--fit paper", "--hold-out 2"})
    acts("--as viewmaps", option);
}

TEST_F(PlenopticFramesTest, SynthMakesSome) {
  ASSERT_EQ(slf("synth rot1 --frames 2 --bits 5 --plenoptic 5 -o rot --quiet").code, 0);
  ASSERT_EQ(slf("encode rot -o x.slf --quiet").code, 0);
  const auto report = parsed(slf("eval x.slf rot --json").out);
  EXPECT_EQ(report["coded"]["exact"], true);
  EXPECT_EQ(report["coded"]["views"].size(), 5u);
  expect_failure(slf("synth turn --plenoptic 5 -o t"), 2, "--plenoptic", "clouds");
}

}  // namespace
}  // namespace slf::cli_plenoptic_frames_test
