// SPDX-License-Identifier: Apache-2.0
// slf encode: grids, presets, images of another exposure, clouds without cameras.
#include <map>

#include "cli_support.h"
#include "slf/capture.h"

namespace slf::cli_encode_test {
namespace {

TEST_F(TinyCaptureTest, AnImageOfAnotherExposureIsCorrectedAndSaidSo) {
  const std::string how = "encode tiny -o a.slf --grid-bits 5 --effort 1 --json";
  EXPECT_TRUE(parsed(slf(how).out)["camera_check"].empty());
  const auto cameras = parsed(read("tiny/cameras.json"));
  const std::string darker = cameras["splits"]["dense"][6];
  auto image = read_image(path("tiny/" + darker));
  ASSERT_TRUE(image) << image.error().message;
  for (std::uint8_t& value : image->data) value /= 2;
  ASSERT_TRUE(write_png(path("tiny/" + darker), *image));
  const Ran ran = slf(how);
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto report = parsed(ran.out);
  ASSERT_EQ(report["camera_check"].size(), 1u) << report["camera_check"];
  EXPECT_EQ(report["camera_check"][0]["image"], darker);
  EXPECT_EQ(report["camera_check"][0]["verdict"], "gain");
  for (const double gain : report["camera_check"][0]["gain"]) EXPECT_NEAR(gain, 2, 0.1);
  EXPECT_NE(ran.err.find("slf: warning: " + darker + ": another exposure"), std::string::npos)
      << ran.err;
  EXPECT_TRUE(report["settings"].contains("cameras_gain_corrected"));
  const auto off = parsed(slf(how + " --check-cameras off").out);
  EXPECT_TRUE(off["camera_check"].empty());
  EXPECT_FALSE(off["settings"].contains("cameras_gain_corrected"));
}

TEST_F(TinyCaptureTest, PhotographsOfManyExposuresAreMatchedAndSaidSo) {
  const std::string how = "encode tiny -o a.slf --grid-bits 5 --effort 1 --surface given --json";
  EXPECT_FALSE(parsed(slf(how).out)["exposure"]["matched"].get<bool>());
  ASSERT_EQ(slf("synth can -o tiny --size 48x48 --points 3000 --circles 5 --per-circle 40 "
                "--supersampling 1 --exposure-drift 0.2")
                .code,
            0);
  const auto pictures = [&](const std::string& more) {
    const Ran ran = slf("eval a.slf tiny --json " + more);
    return parsed(ran.out)["held_out"]["image"]["psnr"].get<double>();
  };
  const auto off = parsed(slf(how + " --match-exposure off").out);
  EXPECT_FALSE(off["exposure"]["matched"].get<bool>());
  EXPECT_FALSE(off["settings"].contains("exposure"));
  const double before = pictures("--match-exposure");
  const auto on = parsed(slf(how).out);
  EXPECT_TRUE(on["exposure"]["matched"].get<bool>());
  EXPECT_EQ(on["settings"]["exposure"], "matched");
  EXPECT_LT(on["exposure"]["differ_matched"], 0.5 * on["exposure"]["differ"].get<double>());
  const double after = pictures("--match-exposure");
  EXPECT_GT(after, before);
  EXPECT_GT(after, pictures("") + 1);
  expect_failure(slf("encode tiny -o b.slf --memory 1G --match-exposure on"), 2, "match-exposure",
                 "");
}

TEST_F(TinyCaptureTest, PosesAreRefinedWhereThatIsAskedForAndSaid) {
  const std::string how = "encode tiny -o a.slf --grid-bits 5 --effort 1 --surface given --json";
  const auto given = parsed(slf(how).out);
  EXPECT_FALSE(given["poses"]["refined"].get<bool>());
  EXPECT_FALSE(given["settings"].contains("poses"));
  const auto refined = parsed(slf(how + " --refine-cameras on").out);
  EXPECT_TRUE(refined["poses"]["refined"].get<bool>());
  EXPECT_EQ(refined["settings"]["poses"], "refined");
  EXPECT_GT(refined["poses"]["most_pixels"], 0);
  const auto as_given = parsed(slf("eval a.slf tiny --json").out)["held_out"]["image"];
  const auto aligned = parsed(slf("eval a.slf tiny --align-cameras --json").out);
  EXPECT_GT(as_given["off_pixels"], 0);
  EXPECT_GT(aligned["held_out"]["image"]["psnr"], as_given["psnr"]);
  for (const char* other : {"encode tiny -o b.slf --memory 1G", "encode tiny/points.ply -o b.slf"})
    expect_failure(slf(std::string(other) + " --refine-cameras on"), 2, "refine-cameras", "");
}

TEST_F(TinyCaptureTest, TheGridFollowsThePhotographsUnlessItIsGiven) {
  const auto report = parsed(slf("encode tiny -o a.slf --effort 1 --json").out);
  EXPECT_EQ(report["settings"]["grid"], "auto");
  EXPECT_EQ(report["grid"]["bits"], report["settings"]["grid_bits"]);
  EXPECT_NEAR(report["grid"]["voxel_pixels"].get<double>(),
              std::stod(report["settings"]["voxel_pixels"].get<std::string>()), 0.006);
  ASSERT_EQ(slf("encode tiny -o b.slf --effort 1 --grid-bits auto").code, 0);
  EXPECT_EQ(read("a.slf"), read("b.slf"));
  const auto given = parsed(slf("encode tiny -o a.slf --effort 1 --grid-bits 4 --json").out);
  EXPECT_EQ(given["settings"]["grid"], "given");
  EXPECT_EQ(given["grid"]["bits"], 4);
  expect_failure(slf("encode tiny -o a.slf --grid-bits 0"), 2, "--grid-bits", "1 to 21");
}

TEST_F(TinyCaptureTest, WhatCoordinatesMeanIsKeptAsWellKnownText) {
  const std::string wkt = "PROJCS[\"ETRS89 / UTM 33N\",AUTHORITY[\"EPSG\",\"25833\"]]";
  const std::string how = "encode tiny -o a.slf --effort 1 --grid-bits 5 --quiet";
  const auto crs = [&] {
    std::string found;
    const auto info = parsed(slf("info a.slf --json").out);
    for (const auto& pair : info["metadata"])
      if (pair["key"] == "crs") found = pair["value"];
    return found;
  };
  ASSERT_EQ(slf(how).code, 0);
  EXPECT_EQ(crs(), "");
  write("given.wkt", "\n" + wkt + "\r\n");
  ASSERT_EQ(slf(how + " --crs given.wkt").code, 0);
  EXPECT_EQ(crs(), wkt);
  write("tiny/points.prj", "GEOGCS[\"WGS 84\"]");  // beside the cloud
  ASSERT_EQ(slf(how).code, 0);
  EXPECT_EQ(crs(), "GEOGCS[\"WGS 84\"]");
  EXPECT_NE(slf("info a.slf").out.find("WGS 84"), std::string::npos);
  for (const char* none : {"", "WGS 84", "PROJCS[\"x\"", "PROJCS]x[", "POINT(1 2)",
                           "PROJCS[\"x\x1b\"]", "PROJCS[\"x]"}) {
    write("given.wkt", none);
    expect_failure(slf(how + " --crs given.wkt"), 4, "given.wkt", "well-known text");
  }
  write("tiny/points.prj", "no");
  const Ran warned = slf("encode tiny -o a.slf --effort 1 --grid-bits 5");
  EXPECT_EQ(warned.code, 0);
  EXPECT_NE(warned.err.find("points.prj"), std::string::npos) << warned.err;
  EXPECT_EQ(crs(), "");
}

TEST_F(TinyCaptureTest, SameBytesForAnyNumberOfThreads) {
  for (const char* threads : {"1", "2", "7"})
    ASSERT_EQ(
        slf(std::string("encode tiny --grid-bits 6 -o ") + threads + ".slf -j " + threads).code, 0);
  EXPECT_EQ(read("1.slf"), read("2.slf"));
  EXPECT_EQ(read("1.slf"), read("7.slf"));
}

TEST_F(TinyCaptureTest, OptionsOverrideThePresetWhateverTheirOrder) {
  const auto settings = [&](const std::string& options) {
    EXPECT_EQ(slf("encode tiny --surface given --grid-bits 5 -o a.slf " + options).code, 0)
        << options;
    std::map<std::string, std::string> metadata;
    const auto info = parsed(slf("info a.slf --json").out);
    for (const auto& pair : info["metadata"]) metadata[pair["key"]] = pair["value"];
    metadata["coder"] = info["coefficient_coder"];
    return metadata;
  };
  const auto paper = settings("--preset paper");
  EXPECT_EQ(paper.at("steps"), "uniform");
  EXPECT_EQ(paper.at("penalise_dc"), "on");
  EXPECT_EQ(paper.at("coder"), "independent");
  const auto changed = settings("--steps by-norm --free-dc -q 8 --preset paper");
  EXPECT_EQ(changed.at("steps"), "by-norm");
  EXPECT_EQ(changed.at("penalise_dc"), "off");
  EXPECT_EQ(changed.at("q"), "8");
  EXPECT_EQ(changed.at("coder"), "independent");
}

TEST_F(TinyCaptureTest, QualityIsChosenUnlessItIsGiven) {
  const std::string how = "encode tiny --grid-bits 6 --effort 2 --json -o ";
  const auto chosen = parsed(slf(how + "a.slf").out);
  EXPECT_TRUE(chosen["quality"]["chosen"].get<bool>()) << chosen["quality"];
  EXPECT_LE(chosen["quality"]["loss"].get<double>(), 0.1);
  EXPECT_EQ(chosen["settings"]["quality_loss"], "0.1");
  ASSERT_EQ(slf(how + "b.slf --quality auto --quality-loss 0.1").code, 0);
  EXPECT_EQ(read("b.slf"), read("a.slf"));
  const auto given = parsed(slf(how + "b.slf -q 16").out);
  EXPECT_EQ(given["q"], 16);
  EXPECT_EQ(given["quality"]["reason"], "given");
  EXPECT_FALSE(given["settings"].contains("quality"));
  const Ran quick = slf("encode tiny --grid-bits 5 --effort 1 -o b.slf");
  EXPECT_NE(quick.err.find("quality       Q 16, not chosen: nothing is fitted to pictures"),
            std::string::npos)
      << quick.err;
}

TEST_F(TinyCaptureTest, ALossIsOfAQualityThatIsChosen) {
  for (const char* wrong : {"0", "10.1", "nan", "little"})
    expect_failure(slf(std::string("encode tiny -o a.slf --quality-loss ") + wrong), 2,
                   "--quality-loss", wrong);
  for (const char* with : {"-q 8", "--preset paper"})
    expect_failure(slf(std::string("encode tiny -o a.slf --quality-loss 1 ") + with), 2,
                   "--quality-loss", "--quality auto");
  expect_failure(slf("encode tiny -o a.slf --quality-loss 1 --target-bytes 9000"), 2,
                 "--quality-loss", "--target-bytes");
}

TEST_F(CliTest, ACloudWithColoursNeedsNoCameras) {
  write("cloud.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 0 1 0 0 255\n");
  ASSERT_EQ(slf("encode cloud.ply -o a.slf --grid-bits 1 -q 0.05").code, 0);
  ASSERT_EQ(slf("decode a.slf --dump dump -o back.ply").code, 0);
  EXPECT_EQ(parsed(read("dump/light_field.json"))["num_functions"], 1);
  const std::string back = read("back.ply");
  const std::string body = back.substr(back.find("end_header\n") + 11);
  ASSERT_EQ(body.size(), 3u * (3 * 4 + 3));
  EXPECT_EQ(body.substr(12, 3), std::string("\xff\0\0", 3)) << "the first in Morton order";
}

TEST_F(CliTest, AReportHasTheWarningsOfTheCaptureToo) {
  write("mesh.ply",
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
        "element face 1\nproperty list uchar int vertex_indices\n"
        "end_header\n0 0 0 255 0 0\n1 0 0 0 255 0\n0 0 1 0 0 255\n3 0 1 2\n");
  const Ran ran = slf("encode mesh.ply -o a.slf --grid-bits 1 -q 0.05 --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto warnings = parsed(ran.out)["warnings"];
  ASSERT_EQ(warnings.size(), 1u) << warnings;
  const std::string said = warnings[0];
  EXPECT_NE(said.find("faces are ignored"), std::string::npos) << said;
  EXPECT_NE(ran.err.find("slf: warning: " + said), std::string::npos) << ran.err;
}

}  // namespace
}  // namespace slf::cli_encode_test
