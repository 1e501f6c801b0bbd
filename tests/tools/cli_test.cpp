// SPDX-License-Identifier: Apache-2.0
// The program as a person meets it: verbs on a tiny capture, usage errors, reports.
#include <algorithm>
#include <map>

#include "cli_support.h"
#include "slf/gaussian_files.h"

namespace slf::cli_test {
namespace {

TEST_F(CliTest, HelpAndVersionExitWithZeroOnStandardOutput) {
  const Ran version = slf("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("slf ", 0), 0u) << version.out;
  EXPECT_EQ(std::count(version.out.begin(), version.out.end(), '.'), 2) << version.out;
  EXPECT_EQ(slf("-V").out, version.out);
  const Ran help = slf("--help");
  EXPECT_EQ(slf("help").out, help.out);
  EXPECT_EQ(slf("help decode").out, slf("decode --help").out);
  expect_failure(slf("help nothing"), 2, "nothing", "is not a verb");
  EXPECT_EQ(help.code, 0);
  EXPECT_NE(help.out.find("130 cancelled"), std::string::npos);
  for (const char* verb : {"synth", "encode", "pack", "decode", "render", "eval", "igc", "info"}) {
    EXPECT_NE(help.out.find(verb), std::string::npos);
    const Ran of_verb = slf(std::string(verb) + " --help");
    EXPECT_EQ(of_verb.code, 0) << verb;
    EXPECT_NE(of_verb.out.find("Usage: slf " + std::string(verb)), std::string::npos);
    EXPECT_EQ(of_verb.err, "");
  }
}

TEST_F(CliTest, UsageErrorsAreOneLineAndExitWithTwo) {
  expect_failure(slf(""), 2, "", "slf --help");
  expect_failure(slf("frobnicate"), 2, "frobnicate", "not a verb");
  expect_failure(slf("encode a -o b -Q 3"), 2, "", "not expected: -Q 3");
  expect_failure(slf("info"), 2, "", "FILE is required");
  expect_failure(slf("encode a -o b --grid-bits 22"), 2, "--grid-bits", "1 to 21");
  expect_failure(slf("encode a -o b --effort 9"), 2, "--effort", "1 to 8");
  expect_failure(slf("encode a -o b --lambda nan"), 2, "--lambda", "nan");
  expect_failure(slf("encode a -o b --delta inf"), 2, "--delta", "inf");
  expect_failure(slf("encode a -o b --functions 100"), 2, "--functions", "power of two");
  expect_failure(slf("encode a -o b --scales 1,2 --functions 8"), 2, "--scales", "");
  const auto contradiction = [&](const char* options, const char* option, const char* of) {
    expect_failure(slf(std::string("encode a -o b ") + options), 2, option, of);
  };
  contradiction("--fit paper --degree 3", "--degree", "--basis harmonics");
  contradiction("--fit hierarchical --basis bspline --degree 3", "--degree", "--basis harmonics");
  contradiction("--fit hierarchical --order 3", "--order", "--basis bspline");
  contradiction("--fit hierarchical --functions 64", "--functions", "--basis bspline");
  contradiction("--fit hierarchical --basis auto --scales 3,3", "--scales", "--basis bspline");
  contradiction("--fit hierarchical --lambda 1", "--lambda", "--fit paper");
  contradiction("--fit hierarchical --free-dc", "--free-dc", "--fit paper");
  contradiction("--fit paper --basis harmonics", "--basis harmonics", "--fit hierarchical");
  contradiction("--fit paper --block-strength 1", "--block-strength", "--fit hierarchical");
  contradiction("--fit paper --cross-validate on", "--cross-validate", "--fit hierarchical");
  contradiction("--texture-qp 5", "--texture-qp", "--coefficients texture");
  contradiction("--preset paper --effort 3", "--effort", "--preset default");
  contradiction("--fit paper --effort 3", "--effort", "--fit hierarchical");
  contradiction("--fit hierarchical --cross-validate off --directions auto", "--directions auto",
                "--cross-validate on");
  contradiction("--fit hierarchical --environment-radius 1", "--environment-radius", "2 to 1e");
  expect_failure(slf("encode a -o b --preset best"), 2, "--preset", "default|paper");
  expect_failure(slf("encode a -o b --metadata nothing"), 2, "--metadata", "KEY=VALUE");
  for (const char* key :
       {"q=99", "split=all", "grid_bits=3", "surface_start=x", "exposure=x", "poses=x"})
    expect_failure(slf(std::string("encode a -o b --metadata ") + key), 2, "--metadata",
                   "the encoder writes this key itself");
  expect_failure(slf("encode a -o b --metadata k=1 k=2"), 2, "--metadata", "twice");
  expect_failure(slf("encode a -o - --json"), 2, "--json", "standard output");
  expect_failure(slf("render a -o b.png --size 0x5"), 2, "--size", "WxH");
  expect_failure(slf("render a -o b.png --background 1,2,256"), 2, "--background", "0 to 255");
  expect_failure(slf("render a -o b.png --orbit 3"), 2, "b.png", "%d");
  expect_failure(slf("decode a"), 2, "--output", "missing");
}

TEST_F(CliTest, NumbersAreReadInOneWayEverywhere) {
  for (const char* option :
       {"encode a -o b --group", "encode a -o b --rate", "encode a -o b --grid-bits",
        "encode a -o b --lambda", "synth can -o b --seed", "render a -o b.png --fov",
        "render a -o b.png --azimuth", "render a -o b.png --radius", "export a -o b.ply --size"}) {
    const std::string flag = std::string(option).substr(std::string(option).rfind(' ') + 1);
    for (const char* value : {"0x10", "+2", "' 1'", "nan", "1e", "''"})
      expect_failure(slf(std::string(option) + " " + value), 2, flag, "");
  }
  for (const char* seed : {"--seed=-1", "--seed=99999999999999999999", "--seed=4294967296"})
    expect_failure(slf(std::string("synth can -o b ") + seed), 2, "--seed", "0 to 4294967295");
  EXPECT_FALSE(exists("b"));
}

TEST_F(TinyCaptureTest, WhatIsForOtherInputsIsRefusedByName) {
  for (const char* surface : {"trained", "splats", "mended"})
    expect_failure(slf(std::string("encode tiny/points.ply -o x.slf --quiet --surface ") + surface),
                   2, surface, "photographs");
  for (const char* option : {"--group 4", "--rate 5", "--refit-still"})
    expect_failure(slf(std::string("encode tiny -o x.slf --quiet ") + option), 2,
                   std::string(option).substr(0, std::string(option).find(' ')), "frames");
  EXPECT_FALSE(exists("x.slf"));
}

TEST_F(TinyCaptureTest, EveryVerbAgreesOnWhatWasEncoded) {
  const Ran encoded =
      slf("encode tiny -o a.slf --surface given --grid-bits 6 --fit paper --functions 32 "
          "--normal-bits 6 "
          "--metadata title=can --json");
  ASSERT_EQ(encoded.code, 0) << encoded.err;
  const auto report = parsed(encoded.out);
  EXPECT_EQ(report["bytes"], read("a.slf").size());
  EXPECT_GT(report["observations"], report["points"]);

  const auto info = parsed(slf("info a.slf --json").out);
  EXPECT_EQ(info["points"], report["points"]);
  EXPECT_EQ(info["complete"], true);
  EXPECT_EQ(info["header"]["basis"]["scales_theta"], 3);
  EXPECT_EQ(info["header"]["basis"]["scales_gamma"], 2);
  std::uint64_t bytes = 0;
  for (const auto& [type, of_type] : info["bytes_by_type"].items())
    bytes += of_type.get<std::uint64_t>();
  EXPECT_EQ(bytes, report["bytes"]);
  EXPECT_EQ(info["bytes_by_type"]["signature"], 8);
  std::map<std::string, std::string> metadata;
  for (const auto& pair : info["metadata"]) metadata[pair["key"]] = pair["value"];
  EXPECT_EQ(metadata["source"], "tiny") << "never more of a path than its last name";
  EXPECT_EQ(metadata["title"], "can");
  EXPECT_EQ(metadata["functions"], "32");

  ASSERT_EQ(slf("decode a.slf -o means.ply --quiet").code, 0);
  ASSERT_EQ(slf("decode a.slf -o a.ply --dump dump").code, 0);
  EXPECT_EQ(read("means.ply"), read("a.ply")) << "decoded of less";
  EXPECT_NE(read("a.ply").find("element vertex " + std::to_string(report["points"].get<int>())),
            std::string::npos);
  EXPECT_NE(read("a.ply").find("property float nx"), std::string::npos);
  const auto field = parsed(read("dump/light_field.json"));
  EXPECT_EQ(field["normal_bits"], 6);
  EXPECT_TRUE(exists("dump/octahedral.npy"));

  const auto quality = parsed(slf("eval a.slf tiny --json").out);
  // Measured: 19.5 and 17.2 dB, SSIM 0.325; half a voxel is two texels of the label.
  EXPECT_GT(quality["input"]["points"][0]["psnr"], 19);
  EXPECT_GT(quality["held_out"]["points"][0]["psnr"], 16.7);
  EXPECT_GT(quality["held_out"]["image"]["coverage"], 0.8);
  EXPECT_GT(quality["held_out"]["image"]["ssim"], 0.3);
  EXPECT_EQ(quality["settings"], report["settings"]);
  EXPECT_EQ(quality["bytes_by_type"], report["bytes_by_type"]);
  const auto wider = parsed(slf("eval a.slf tiny --json --no-images --delta-eval 0,10,30").out);
  ASSERT_EQ(wider["held_out"]["points"].size(), 3u);
  EXPECT_EQ(wider["held_out"]["points"][1], quality["held_out"]["points"][0]);
  EXPECT_TRUE(wider["held_out"]["image"].is_null());
  expect_failure(slf("eval a.slf tiny --no-images --min-psnr 200 >/dev/null"), 8, "a.slf",
                 "below 200 dB");
  EXPECT_EQ(slf("eval a.slf tiny --no-images --min-psnr 10").code, 0);
}

TEST_F(TinyCaptureTest, RendersOrbitsCamerasPairsAndSheets) {
  ASSERT_EQ(slf("encode tiny -o a.slf --surface given --grid-bits 6 --functions 8").code, 0);
  const auto size_of = [&](const std::string& name) {  // IHDR: width and height, big endian
    const std::string png = read(name);
    EXPECT_EQ(png.rfind("\x89PNG", 0), 0u) << name;
    if (png.size() < 24) return std::pair(0, 0);
    const auto number = [&](std::size_t at) {
      return (static_cast<unsigned char>(png[at + 2]) << 8) |
             static_cast<unsigned char>(png[at + 3]);
    };
    return std::pair(number(16), number(20));
  };
  ASSERT_EQ(slf("render a.slf -o one.png").code, 0);
  EXPECT_EQ(size_of("one.png"), std::pair(800, 800));
  ASSERT_EQ(slf("render a.slf --orbit 3 --size 40x30 -o view%02d.png").code, 0);
  EXPECT_EQ(size_of("view02.png"), std::pair(40, 30));
  EXPECT_FALSE(exists("view03.png"));
  ASSERT_EQ(slf("render a.slf --orbit 2 --size 40x30 -o views/").code, 0);
  EXPECT_EQ(size_of("views/001.png"), std::pair(40, 30));
  ASSERT_EQ(slf("render a.slf --orbit 8 --size 40x30 --sheet -o sheet.png").code, 0);
  EXPECT_EQ(size_of("sheet.png"), std::pair(160, 60));
  const auto camera = parsed(read("tiny/cameras.json"))["cameras"][1]["image"].get<std::string>();
  ASSERT_EQ(slf("render a.slf --camera tiny/cameras.json:" + camera + " -o name.png").code, 0);
  ASSERT_EQ(slf("render a.slf --camera tiny/cameras.json:1 -o index.png").code, 0);
  EXPECT_EQ(read("name.png"), read("index.png"));
  EXPECT_EQ(size_of("name.png"), std::pair(48, 48));
  ASSERT_EQ(slf("render a.slf --capture tiny --image " + camera + " -o image.png").code, 0);
  EXPECT_EQ(read("name.png"), read("image.png"));
  ASSERT_EQ(slf("render a.slf --capture tiny --image " + camera + " --pair -o pair.png").code, 0);
  EXPECT_EQ(size_of("pair.png"), std::pair(96, 48));
  EXPECT_EQ(slf("render a.slf --transparent --diffuse-only --size 40x30 -o clear.png").code, 0);
  expect_failure(slf("render a.slf --camera tiny/cameras.json:none -o x.png"), 4, "cameras.json",
                 "no camera none");
}

TEST_F(TinyCaptureTest, OneViewIsNumberedAsSeveralAre) {
  ASSERT_EQ(slf("encode tiny -o a.slf --effort 1 --grid-bits 5 --quiet").code, 0);
  ASSERT_EQ(slf("render a.slf --orbit 1 --size 16x16 -o turn%03d.png").code, 0);
  ASSERT_EQ(slf("render a.slf --camera tiny/cameras.json:1 --size 16x16 -o camera%d.png").code, 0);
  EXPECT_TRUE(exists("turn000.png") && exists("camera0.png"));
}

TEST_F(CliTest, HelpThatCannotBeWrittenIsAFailedWrite) {
  for (const char* asked : {"--version", "--help", "encode --help"})
    expect_failure(slf(std::string(asked) + " >/dev/full"), 7, "standard output", "");
}

TEST_F(TinyCaptureTest, PartsOfAFileDecode) {
  ASSERT_EQ(slf("encode tiny -o a.slf --surface given --grid-bits 6").code, 0);
  const auto points = [&](const std::string& options) {
    const Ran ran = slf("decode a.slf -o a.ply --json " + options);
    EXPECT_EQ(ran.code, 0) << ran.err;
    return parsed(ran.out);
  };
  const auto whole = points(""), coarse = points("--levels 4"), smooth = points("--groups 1");
  EXPECT_LT(coarse["points"], whole["points"]);
  EXPECT_EQ(coarse["grid_bits"], 4);
  EXPECT_EQ(smooth["points"], whole["points"]);
  EXPECT_EQ(whole["partial"], false);
  EXPECT_EQ(points("--max-bytes " + std::to_string(read("a.slf").size() / 2))["partial"], true);
  expect_failure(slf("decode a.slf -o b.ply --levels 7"), 2, "a.slf", "that many");
  EXPECT_FALSE(exists("b.ply"));
}

TEST_F(TinyCaptureTest, ExportsSplatsAndPointsAndSaysWhatIsLost) {
  ASSERT_EQ(slf("encode tiny -o a.slf --surface given --grid-bits 6").code, 0);
  for (const char* file : {"a.ply", "a.glb", "a.spz"}) {
    const Ran ran = slf(std::string("export a.slf --json --degree 2 -o ") + file);
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto report = parsed(ran.out);
    EXPECT_EQ(report["bytes"], read(file).size());
    EXPECT_EQ(report["degree"], 2);
    EXPECT_GT(report["psnr"], report["psnr_one_colour"]);
  }
  ASSERT_EQ(slf("export a.slf --quiet --mean -o mean.ply").code, 0);
  ASSERT_EQ(slf("decode a.slf --quiet -o decoded.ply").code, 0);
  EXPECT_EQ(read("mean.ply"), read("decoded.ply"));
  EXPECT_EQ(slf("export a.slf --quiet --format spz --degree 2 -o -").out, read("a.spz"));
  EXPECT_EQ(slf("export a.slf --quiet --spz-version 2 --degree 2 -o b.spz").code, 0);
  EXPECT_EQ(read("b.spz"), read("a.spz"));
  EXPECT_EQ(slf("export a.slf --quiet --spz-version 3 --degree 2 -o b.spz").code, 0);
  EXPECT_EQ(read_gaussians(path("b.spz"))->format, "SPZ 3");
  expect_failure(slf("export a.slf -o a.obj"), 2, "a.obj", "--format");
  expect_failure(slf("export a.slf --mean -o c.spz"), 2, "export", "--mean");
  expect_failure(slf("export tiny/cameras.json -o c.spz"), 4, "cameras.json", "not an .slf");
  EXPECT_FALSE(exists("c.spz"));
}

}  // namespace
}  // namespace slf::cli_test
