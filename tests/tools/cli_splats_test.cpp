// SPDX-License-Identifier: Apache-2.0
// Files of Gaussian splats through the program: drawn, and written in another format.
#include "cli_support.h"
#include "slf/capture.h"
#include "tests/lightfield/gaussian_support.h"

namespace slf::cli_splats_test {
namespace {

class SplatFileTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    const auto bytes = gaussian_file(test::random_gaussians(300, 2), SplatFormat::kPly);
    write("x.ply", {bytes->begin(), bytes->end()});
  }
};

TEST_F(SplatFileTest, IsDrawnAndItsCopiesInOtherFormatsAre) {
  ASSERT_EQ(slf("render x.ply -o x.png --size 90x70").code, 0);
  const auto image = read_image(path("x.png"));
  ASSERT_TRUE(image);
  EXPECT_EQ(image->width, 90);
  EXPECT_NE(*std::min_element(image->data.begin(), image->data.end()),
            *std::max_element(image->data.begin(), image->data.end()));
  for (const std::string format : {"spz", "glb"}) {
    EXPECT_EQ(slf("export x.ply -o x." + format).code, 0);
    EXPECT_EQ(slf("render x." + format + " --orbit 2 --sheet -o sheet.png --size 50x50").code, 0);
  }
  for (const std::string options : {"-o four.spz --spz-version 4", "-o x.sog"}) {
    const Ran ran = slf("export x.ply " + options);
    ASSERT_TRUE(ran.code == 0 || ran.err.find("this build") != std::string::npos) << ran.err;
    if (ran.code != 0) continue;
    const std::string file = options.substr(3, options.find(' ', 3) - 3);
    EXPECT_EQ(slf("render " + file + " -o sheet.png --size 50x50").code, 0);
    EXPECT_EQ(slf("encode " + file + " -o x.slf --quiet").code, 0);
  }
  expect_failure(slf("export x.ply -o y.glb --spz-version 4"), 2, "y.glb", "--spz-version");
  ASSERT_EQ(slf("export x.glb -o back.ply").code, 0);
  EXPECT_EQ(read_gaussians(path("back.ply"))->gaussians.positions,
            read_gaussians(path("x.ply"))->gaussians.positions);
}

TEST_F(SplatFileTest, IsReportedAndCutToADegree) {
  const Ran ran = slf("export x.ply -o y.ply --degree 1 --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto report = parsed(ran.out);
  EXPECT_EQ(report["splats"], 300);
  EXPECT_EQ(report["degree"], 1);
  EXPECT_EQ(report["input_format"], "PLY");
  EXPECT_EQ(report["bytes"], read("y.ply").size());
  EXPECT_EQ(read_gaussians(path("y.ply"))->gaussians.degree, 1);
}

TEST_F(SplatFileTest, IsRefusedWhereAnOptionMeansNothingForItAndWhenDamaged) {
  expect_failure(slf("render x.ply -o x.png --levels 2"), 2, "x.ply", "no part");
  expect_failure(slf("export x.ply -o x.spz --axes world"), 2, "x.ply", "--axes");
  expect_failure(slf("export x.ply -o x.spz --size 2"), 2, "x.ply", "--size");
  expect_failure(slf("render x.ply -o x.png --radius 2"), 2, "x.ply", "--radius");
  std::string text = read("x.ply");
  text.resize(text.size() - 9);
  write("cut.ply", text);
  EXPECT_NE(slf("render cut.ply -o x.png").code, 0);
  write("new.spz", std::string("NGSP\4\0\0\0", 8) + std::string(24, '\0'));
  const Ran ran = slf("render new.spz -o x.png");
  EXPECT_NE(ran.err.find("new.spz: SPZ"), std::string::npos) << ran.err;
  EXPECT_NE(ran.code, 0);
}

TEST_F(SplatFileTest, KeepsTheReferenceSystemThatItIsGiven) {
  write("a.prj", "GEOGCRS[\"some place\"]");
  ASSERT_EQ(slf("encode x.ply --crs a.prj -o x.slf").code, 0);
  EXPECT_NE(slf("info x.slf").out.find("some place"), std::string::npos);
  expect_failure(slf("encode x.ply --crs none.prj -o x.slf"), 3, "none.prj", "");
}

TEST_F(SplatFileTest, HasTheNearestFileOfATargetThatNoStepMeets) {
  for (const char* target : {"--target-bytes 10", "--target-bytes 9000000", "--target-psnr 99"}) {
    const Ran ran = slf("encode x.ply -o x.slf --json " + std::string(target));
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto report = parsed(ran.out);
    ASSERT_EQ(report["warnings"].size(), 1u) << target;
    EXPECT_NE(ran.err.find("warning: no step gives"), std::string::npos) << ran.err;
    EXPECT_EQ(report["bytes"], read("x.slf").size());
  }
}

TEST_F(SplatFileTest, AViewOfACameraHasNothingOfAnOrbit) {
  for (const char* option : {"--azimuth 5", "--elevation 5", "--fov 5", "--sheet"})
    expect_failure(slf("render x.ply -o x.png --camera cameras.json:0 " + std::string(option)), 2,
                   "--camera", std::string(option).substr(0, std::string(option).find(' ')));
}

TEST_F(SplatFileTest, APipeThatNobodyReadsEndsWithTheProgram) {
  ASSERT_EQ(slf("encode x.ply -o x.slf --quiet").code, 0);
  ASSERT_EQ(shell("mkfifo pipe").code, 0);
  EXPECT_EQ(slf("export x.slf --format ply -o pipe", "timeout -k 20 1").code, 124);
}

TEST_F(SplatFileTest, IsCodedDrawnJudgedAndWrittenAgain) {
  const Ran coded = slf("encode x.ply -o x.slf -q 3 --json");
  ASSERT_EQ(coded.code, 0) << coded.err;
  const auto report = parsed(coded.out);
  EXPECT_EQ(report["bytes"], read("x.slf").size());
  EXPECT_EQ(report["q"], 3);
  EXPECT_NE(slf("info x.slf").out.find("shape"), std::string::npos);
  ASSERT_EQ(slf("render x.slf -o a.png --size 80x80").code, 0);
  ASSERT_EQ(slf("render x.ply -o b.png --size 80x80").code, 0);
  EXPECT_EQ(slf("export x.slf -o y.ply").code, 0);
  EXPECT_EQ(read_gaussians(path("y.ply"))->gaussians.size(), report["splats"]);
  EXPECT_EQ(slf("export x.slf -o y.spz").code, 0);
  EXPECT_EQ(slf("encode y.spz -o z.slf --quiet").code, 0);
  if (const Ran page = slf("html x.slf -o x.html --quiet"); page.code != 6) {  // 6: has no page
    EXPECT_EQ(page.code, 0) << page.err;
    EXPECT_NE(read("x.html").find("data:image/jpeg;base64,"), std::string::npos);
  }
  expect_failure(slf("encode x.ply -o w.slf --degree 4"), 2, "x.ply", "--degree");
  expect_failure(slf("export x.ply -o y.ply --mean"), 2, "x.ply", "--mean");
  expect_failure(slf("eval x.ply . --frame 2"), 2, "x.ply", "--frame");
  expect_failure(slf("render x.slf --sheet --orbit 1000 --size 800x800 -o s.png"), 2, "render",
                 "35200 x 18400");
  expect_failure(slf("encode x.ply -o w.slf --points x.ply"), 2, "x.ply", "--points");
}

TEST_F(SplatFileTest, IsCodedFromStandardInputAsFromAFile) {
  ASSERT_EQ(slf("encode x.ply -o x.slf --quiet").code, 0);
  const std::string in_here = "export TMPDIR=$PWD; ";
  const Ran piped = slf("encode - -o piped.slf --quiet", in_here + "cat x.ply |");
  ASSERT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(read("piped.slf"), read("x.slf"));
  ASSERT_EQ(slf("export x.ply -o x.spz").code, 0);
  ASSERT_EQ(slf("encode x.spz -o x.slf --quiet").code, 0);
  ASSERT_EQ(slf("encode - -o piped.slf --quiet", in_here + "cat x.spz |").code, 0);
  EXPECT_EQ(read("piped.slf"), read("x.slf"));
  std::string text = read("x.ply");
  text.resize(text.size() - 9);
  write("cut.ply", text);
  const Ran cut = slf("encode - -o piped.slf --quiet", in_here + "cat cut.ply |");
  EXPECT_EQ(cut.code, 4);
  EXPECT_NE(cut.err.find("standard input: "), std::string::npos) << cut.err;
  EXPECT_EQ(cut.err.find("slf-"), std::string::npos) << cut.err;
  for (const auto& entry : std::filesystem::directory_iterator(path(".")))
    EXPECT_NE(entry.path().filename().string().rfind("slf-", 0), 0u) << "a file is left behind";
}

TEST_F(SplatFileTest, CloudsComeFromStandardInputAndNothingElseDoes) {
  write("c.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "end_header\n0 0 0 1 2 3\n1 2 0 9 9 9\n5 5 5 200 0 7\n");
  ASSERT_EQ(slf("encode c.ply -o c.slf --quiet && '" SLF_PROGRAM "' decode c.slf -o a.ply").code,
            0);
  ASSERT_EQ(slf("encode - -o c.slf --quiet <c.ply && '" SLF_PROGRAM "' decode c.slf -o b.ply").code,
            0);
  EXPECT_EQ(read("b.ply"), read("a.ply"));
  for (const char* opened : {"/dev/stdin", "/dev/fd/3 3<c.ply"}) {
    ASSERT_EQ(slf("encode " + std::string(opened) + " -o d.slf --quiet <c.ply").code, 0);
    ASSERT_EQ(slf("decode d.slf -o d.ply").code, 0);
    EXPECT_EQ(read("d.ply"), read("a.ply")) << opened;
  }
  std::string with_nan = read("c.ply");
  with_nan.replace(with_nan.find("5 5 5"), 5, "5 nan 5");
  write("nan.ply", with_nan);
  const Ran warned = slf("encode - -o c.slf <nan.ply");
  EXPECT_EQ(warned.code, 0);
  EXPECT_NE(warned.err.find("warning: standard input: "), std::string::npos) << warned.err;
  EXPECT_EQ(warned.err.find("slf-"), std::string::npos) << warned.err;
  expect_failure(slf("encode - -o n.slf"), 4, "standard input", "is empty");
  write("t.json", "{\"frames\": []}");
  expect_failure(slf("encode - -o n.slf <t.json"), 4, "standard input", "not a PLY");
  EXPECT_FALSE(exists("n.slf"));
}

TEST_F(SplatFileTest, WarnsOfSplatsThatAreLeftOut) {
  write("bad.ply", [] {
    std::string text = test::ascii_header(2, test::kSplatNames);
    return text + "nan 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n0 0 0 0 0 0 0 -3 -3 -3 1 0 0 0\n";
  }());
  const Ran ran = slf("export bad.ply -o good.ply");
  EXPECT_EQ(ran.code, 0);
  EXPECT_NE(ran.err.find("1 splats are left out"), std::string::npos) << ran.err;
}

TEST_F(SplatFileTest, OneFarAwayIsWarnedOfAndCroppedOrRefusedWhereNothingShowsIt) {
  Gaussians splats = test::random_gaussians(300, 0);
  const auto coded = [&](float far, const std::string& options) {
    splats.positions[7] = {0, far, 0};
    const auto bytes = gaussian_file(splats, SplatFormat::kPly);
    write("far.ply", {bytes->begin(), bytes->end()});
    return slf("encode far.ply -o far.slf --json " + options);
  };
  const Ran warned = coded(1e8f, "");
  ASSERT_EQ(warned.code, 0) << warned.err;
  const std::size_t at = warned.err.find("--crop=");
  ASSERT_NE(at, std::string::npos) << warned.err;
  const std::string box = warned.err.substr(at, warned.err.find('\n', at) - at);
  const Ran cropped = coded(1e8f, box);
  ASSERT_EQ(cropped.code, 0) << cropped.err;
  EXPECT_EQ(cropped.err, "");
  EXPECT_LT(parsed(cropped.out)["grid"]["step"],
            1e-3 * parsed(warned.out)["grid"]["step"].get<double>());
  expect_failure(coded(1e30f, "--quiet"), 4, "far.ply", "1e12");
  EXPECT_EQ(coded(1e30f, box).code, 0);
}

TEST_F(SplatFileTest, IsJudgedAgainstPhotographs) {
  ASSERT_EQ(slf("synth can -o can --size 64x64 --points 500 --quiet").code, 0);
  const Ran ran = slf("eval x.ply can --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto report = parsed(ran.out);
  EXPECT_EQ(report["points"], 300);
  EXPECT_EQ(report["bytes"], read("x.ply").size());
  EXPECT_GT(report["input"]["image"]["all"]["psnr"], 3);
  EXPECT_FALSE(report["input"].contains("points"));
  EXPECT_EQ(slf("eval x.ply can --min-image-psnr 99").code, 8);
  expect_failure(slf("eval x.ply can --min-psnr 3"), 2, "x.ply", "--min-psnr");
}

}  // namespace
}  // namespace slf::cli_splats_test
