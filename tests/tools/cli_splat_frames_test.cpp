// SPDX-License-Identifier: Apache-2.0
// Gaussian splats as frames in time through the program: coded, drawn, cut, written again.
#include "cli_support.h"
#include "slf/capture.h"
#include "tests/lightfield/gaussian_support.h"

namespace slf::cli_splat_frames_test {
namespace {

namespace fs = std::filesystem;

constexpr int kFrames = 4;

class SplatFramesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    for (int f = 0; f < kFrames; ++f) splats("s_" + std::to_string(f) + ".ply", at(f));
  }
  /// All move by the same from frame to frame.
  static Gaussians at(int f, int degree = 1) {
    Gaussians out = test::random_gaussians(150, degree);
    for (auto& position : out.positions) position[0] += 0.02F * static_cast<float>(f);
    return out;
  }
  void splats(const std::string& name, const Gaussians& gaussians,
              SplatFormat format = SplatFormat::kPly) const {
    fs::create_directories(path(name).parent_path());
    const auto bytes = gaussian_file(gaussians, format);
    ASSERT_TRUE(bytes);
    write(name, {bytes->begin(), bytes->end()});
  }
  void cloud(const std::string& name, int points) const {
    PointCloud made;
    for (int i = 0; i < points; ++i) {
      made.positions.push_back({static_cast<float>(i), 0, 0});
      made.colours.push_back({90, 90, 40});
    }
    ASSERT_TRUE(write_ply(path(name), made));
  }
};

TEST_F(SplatFramesTest, AreCodedToldDecodedAndWrittenAgainFrameByFrame) {
  const Ran coded = slf("encode s_%d.ply -o x.slf -q 3 --group 3 --rate 10 --json");
  ASSERT_EQ(coded.code, 0) << coded.err;
  const auto report = parsed(coded.out);
  EXPECT_EQ(report["bytes"], read("x.slf").size());
  ASSERT_EQ(report["frames"].size(), 4u);
  EXPECT_EQ(report["frames"][1]["predicted"], true);
  EXPECT_EQ(report["frames"][3]["predicted"], false);
  EXPECT_LT(report["frames"][1]["bytes"], report["frames"][0]["bytes"]);
  const auto info = parsed(slf("info x.slf --json").out);
  EXPECT_EQ(info["frames"].size(), 4u);
  EXPECT_EQ(info["frames"][2]["points"], report["frames"][2]["points"]);
  EXPECT_EQ(slf("decode x.slf --frames 0:3 -o c%d.ply --quiet").code, 0);
  ASSERT_EQ(slf("export x.slf --frames 0:3 -o e%d.ply --quiet").code, 0);
  EXPECT_EQ(slf("export x.slf --frame 2 -o e.spz --quiet").code, 0);
  for (int f = 0; f < kFrames; ++f) {
    const auto back = read_gaussians(path("e" + std::to_string(f) + ".ply"));
    ASSERT_TRUE(back);
    EXPECT_EQ(back->gaussians.size(), report["frames"][static_cast<std::size_t>(f)]["points"]);
    EXPECT_EQ(back->gaussians.degree, 1);
  }
}

TEST_F(SplatFramesTest, AreDrawnAsTheFilesTheyWere) {
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf -q 1 --quiet").code, 0);
  ASSERT_EQ(slf("render x.slf --frames 0:3 -o v%d.png --size 60x60 --quiet").code, 0);
  EXPECT_NE(read("v0.png"), read("v3.png"));
  ASSERT_EQ(slf("export x.slf --frame 3 -o e.ply --quiet").code, 0);
  EXPECT_EQ(slf("render x.slf -o film.avi --size 60x60 --quiet").code, 0);
  EXPECT_EQ(read("film.avi").substr(0, 4), "RIFF");
  ASSERT_EQ(slf("render x.slf --frame 3 -o a.png --size 60x60 --quiet").code, 0);
  ASSERT_EQ(slf("render e.ply -o b.png --size 60x60 --quiet").code, 0);
  const auto a = read_image(path("a.png")), b = read_image(path("b.png"));
  ASSERT_TRUE(a && b);
  ASSERT_EQ(a->data.size(), b->data.size());
  int most = 0;
  for (std::size_t i = 0; i < a->data.size(); ++i)
    most = std::max(most, std::abs(int(a->data[i]) - int(b->data[i])));
  EXPECT_LE(most, 2);
}

TEST_F(SplatFramesTest, ComeFromDirectoriesAndFilesOfOtherFormats) {
  for (int f = 0; f < 2; ++f) {
    splats("spz/a_" + std::to_string(f) + ".spz", at(f), SplatFormat::kSpz3);
    splats("glb/a_" + std::to_string(f) + ".glb", at(f), SplatFormat::kGlb);
  }
  for (const char* input : {".", "spz", "spz/a_%d.spz", "glb"}) {
    const Ran ran = slf("encode " + std::string(input) + " -o x.slf --quiet");
    EXPECT_EQ(ran.code, 0) << input << ran.err;
    EXPECT_NE(slf("info x.slf").out.find("shape"), std::string::npos);
  }
}

TEST_F(SplatFramesTest, ThatAreCutOrMergedAreThoseOfTheWhole) {
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --group 2 --quiet").code, 0);
  for (const char* part : {"1", "2"})
    ASSERT_EQ(slf("encode s_%d.ply --group 2 --quiet --part " + std::string(part) + "/2 -o p" +
                  part + ".slf")
                  .code,
              0);
  ASSERT_EQ(slf("merge p2.slf p1.slf -o m.slf --quiet").code, 0);
  EXPECT_EQ(read("m.slf"), read("x.slf"));
  ASSERT_EQ(slf("truncate x.slf --frames 2:3 -o cut.slf --quiet").code, 0);
  ASSERT_EQ(slf("export x.slf --frame 3 -o a.ply --quiet").code, 0);
  ASSERT_EQ(slf("export cut.slf --frame 1 -o b.ply --quiet").code, 0);
  EXPECT_EQ(read("a.ply"), read("b.ply"));
}

TEST_F(SplatFramesTest, FarFromTheOriginKeepTheirPlacesToEachOther) {
  const Vec3 far{400000, 5700000, 100};  // metres on a map; a float there is half a metre off
  constexpr double kStep = 0.25;
  const auto splat = [&](int i, int f) -> Vec3 {
    return {far[0] + 0.1 * (i % 10) + kStep * f, far[1] + 0.1 * (i / 10), far[2] + 0.02 * i};
  };
  constexpr int kSplats = 40;
  for (int f = 0; f < kFrames; ++f) {
    std::string header = test::ascii_header(kSplats, test::kSplatNames), rows;
    for (const char axis : {'x', 'y', 'z'}) {
      const std::string name = std::string(" ").append(1, axis).append("\n");
      header.replace(header.find("float" + name), 5, "double");
    }
    for (int i = 0; i < kSplats; ++i) {
      for (const double x : splat(i, f)) rows.append(std::to_string(x)).append(" ");
      rows += "0.5 0.5 0.5 3 -3 -3 -3 1 0 0 0\n";
    }
    write("far_" + std::to_string(f) + ".ply", header + rows);
  }
  const Ran coded = slf("encode far_%d.ply -o x.slf -q 0.5 --group 2 --quiet");
  ASSERT_EQ(coded.code, 0) << coded.err;
  std::vector<Vec3> means, origins;
  for (int f = 0; f < kFrames; ++f) {
    const std::string name = "e" + std::to_string(f) + ".ply";
    const Ran ran = slf("export x.slf --json --frame " + std::to_string(f) + " -o " + name);
    ASSERT_EQ(ran.code, 0) << ran.err;
    origins.push_back(parsed(ran.out)["origin"].get<Vec3>());
    const auto back = read_gaussians(path(name));
    ASSERT_TRUE(back);
    ASSERT_EQ(back->gaussians.size(), std::size_t{kSplats});
    Vec3 mean{};
    for (const auto& at : back->gaussians.positions)
      for (std::size_t k = 0; k < 3; ++k) mean[k] += double{at[k]} / kSplats;
    means.push_back(mean);
  }
  for (std::size_t f = 0; f < means.size(); ++f) {
    EXPECT_EQ(origins[f], origins[0]);
    EXPECT_NEAR(origins[f][1], far[1], 10);
    EXPECT_NEAR(means[f][0] - means[0][0], kStep * double(f), 1e-3);
    for (std::size_t k = 0; k < 3; ++k) {
      double mean = 0;
      for (int i = 0; i < kSplats; ++i) mean += splat(i, int(f))[k] / kSplats;
      EXPECT_NEAR(means[f][k] + origins[f][k], mean, 1e-3) << f << " " << k;
    }
  }
  ASSERT_EQ(slf("export x.slf --frames 0:3 -o a%d.ply --quiet").code, 0);
  EXPECT_EQ(read("a3.ply"), read("e3.ply"));
}

TEST_F(SplatFramesTest, ADryRunSaysWhatWouldBeDone) {
  const Ran dry = slf("encode s_%d.ply -o x.slf --dry-run --json");
  ASSERT_EQ(dry.code, 0) << dry.err;
  const auto plan = parsed(dry.out);
  EXPECT_EQ(plan["kind"], "splats");
  EXPECT_EQ(plan["frames"].size(), 4u);
  EXPECT_FALSE(exists("x.slf"));
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet").code, 0);
  EXPECT_EQ(plan["grid"]["step"], parsed(slf("info x.slf --json").out)["header"]["grid"]["step"]);
}

TEST_F(SplatFramesTest, BesideCloudsOrOfAnotherDegreeAreNamed) {
  cloud("s_2.ply", 50);
  expect_failure(slf("encode s_%d.ply -o x.slf --quiet"), 4, "s_2.ply",
                 "frames are all clouds or all splats");
  splats("s_2.ply", at(2, 2));
  expect_failure(slf("encode s_%d.ply -o x.slf --quiet"), 4, "s_2.ply", "degree 2");
  write("t/a_1.spz", "");
  write("s_2.ply", "");
  expect_failure(slf("encode s_%d.ply -o x.slf --quiet"), 4, "s_2.ply", "the frame is empty");
  splats("s_2.ply", at(2));
  std::string cut = read("s_2.ply");
  cut.resize(cut.size() - 20);
  write("s_2.ply", cut);
  const Ran ran = slf("encode s_%d.ply -o x.slf --quiet");
  EXPECT_NE(ran.code, 0);
  EXPECT_NE(ran.err.find("s_2.ply"), std::string::npos) << ran.err;
  EXPECT_FALSE(exists("x.slf"));
}

TEST_F(SplatFramesTest, WithoutSplatsAreEmptyFrames) {
  std::string text = read("s_1.ply");
  text = text.substr(0, text.find("end_header\n") + 11);
  text.replace(text.find("element vertex 150"), 18, "element vertex 0");
  write("s_1.ply", text);
  cloud("s_2.ply", 0);
  const Ran coded = slf("encode s_%d.ply -o x.slf --json");
  ASSERT_EQ(coded.code, 0) << coded.err;
  const auto frames = parsed(coded.out)["frames"];
  EXPECT_EQ(frames[1]["points"], 0);
  EXPECT_EQ(frames[2]["points"], 0);
  EXPECT_EQ(frames[3]["predicted"], false);
  EXPECT_EQ(slf("render x.slf --frames 0:3 -o v%d.png --size 30x30 --quiet").code, 0);
  const Ran written = slf("export x.slf --frames 0:3 -o w%d.ply");
  EXPECT_EQ(written.code, 0);
  EXPECT_NE(written.err.find("x.slf: frame 1 has no points, and no file"), std::string::npos);
  EXPECT_TRUE(exists("w0.ply") && exists("w3.ply") && !exists("w1.ply") && !exists("w2.ply"));
}

TEST_F(SplatFramesTest, AreToldWhatTheirCutsAndNamesNeed) {
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet").code, 0);
  expect_failure(slf("truncate x.slf --levels 2 -o y.slf"), 2, "x.slf", "needs all of the one");
  expect_failure(slf("render x.slf --frames 0:1 --orbit 2 -o v%d.png"), 2, "--output",
                 "one for the view");
  expect_failure(slf("decode x.slf --frames 0:1 --dump d"), 2, "--frames", "%d in its name");
}

TEST_F(SplatFramesTest, EveryFrameIsJudgedAgainstItsCapture) {
  ASSERT_EQ(slf("synth turn --frames 4 --size 24x24 --points 400 --circles 1 --per-circle 8 "
                "-o take --quiet")
                .code,
            0);
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet").code, 0);
  const Ran judged = slf("eval x.slf take --json --quiet");
  ASSERT_EQ(judged.code, 0) << judged.err;
  EXPECT_EQ(parsed(judged.out)["frames"].size(), 4u);
  expect_failure(slf("eval x.slf s_%d.ply"), 2, "s_%d.ply", "measured against captures");
}

TEST_F(SplatFramesTest, OptionsTheyDoNotHaveAreRefusedByNameAndTheOthersAct) {
  ASSERT_EQ(slf("encode s_%d.ply -o plain.slf --quiet").code, 0);
  for (const char* option :
       {"--points x.ply",  "--images d",          "--split all",      "--refit-still",
        "--as colour",     "--memory 300M",       "--work w",         "--effort 2",
        "--colour none",   "--chroma-step 2",     "--steps uniform",  "--normal-bits 6",
        "--linear",        "--target-bytes 3000", "--target-psnr 30", "--quality-layers 2",
        "--base-levels 2", "--slice-points 100",  "--surface splats", "--delta 60",
        "--geometry draco"}) {
    const std::string text = option;
    expect_failure(slf("encode s_%d.ply -o y.slf " + text), 2, text.substr(0, text.find(' ')),
                   "for");
  }
  EXPECT_FALSE(exists("y.slf"));
  for (const char* option :
       {"--crop=-9,-9,-9,9,0.1,9", "--up=+x", "--metadata who=me", "--frames 0:2", "--group 1",
        "--rate 10", "-q 4", "--grid-bits 9", "--voxel-size 0.01", "--metres-per-unit 2",
        "--target-bitrate 150000", "--klt joint", "--predict off", "--reference-contexts off",
        "--rdo 0.7", "--part 1/2 --group 1"}) {
    const Ran ran = slf("encode s_%d.ply -o y.slf --quiet " + std::string(option));
    ASSERT_EQ(ran.code, 0) << option << ran.err;
    EXPECT_TRUE(read("y.slf") != read("plain.slf")) << option;
  }
}

TEST_F(SplatFramesTest, HtmlHoldsAllFrames) {
  ASSERT_EQ(slf("encode s_%d.ply -o x.slf --quiet").code, 0);
  const Ran ran = slf("html x.slf -o x.html --quiet");
  if (ran.err.find("one_file.html") != std::string::npos) GTEST_SKIP() << "built without the page";
  EXPECT_EQ(ran.code, 0) << ran.err;
}

}  // namespace
}  // namespace slf::cli_splat_frames_test
