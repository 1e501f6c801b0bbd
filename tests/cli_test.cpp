// The program as a person meets it: verbs on a tiny capture, usage errors, reports.
#include <algorithm>
#include <map>

#include "cli_support.h"
#include "slf/capture.h"
#include "tools/npy.h"

namespace slf {
namespace {

using tools::npy_file;

std::string text_of(const std::vector<std::uint8_t>& bytes) { return {bytes.begin(), bytes.end()}; }

/// positions.npy with four points and components.npy with two functions of them.
class PackTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("positions.npy", text_of(npy_file({4, 3}, std::span<const std::int32_t>(positions_))));
    write("components.npy",
          text_of(npy_file({4, 2, 3}, std::span<const std::int32_t>(components_))));
  }
  // In Morton order (x least significant), so that decoding gives the same arrays.
  std::vector<std::int32_t> positions_{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 6, 7};
  std::vector<std::int32_t> components_{10, -20, 30, 1, 2, 3, 11, -21, 31, 4,  5, 6,
                                        12, -22, 32, 7, 8, 9, 13, -23, 33, 10, 0, -12};
};

TEST_F(CliTest, HelpAndVersionExitWithZeroOnStandardOutput) {
  const Ran version = slf("--version");
  EXPECT_EQ(version.code, 0);
  EXPECT_EQ(version.out.rfind("slf ", 0), 0u) << version.out;
  EXPECT_EQ(std::count(version.out.begin(), version.out.end(), '.'), 2) << version.out;
  const Ran help = slf("--help");
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
  expect_failure(slf("info"), 2, "", "FILE is required");
  expect_failure(slf("encode a -o b --grid-bits 22"), 2, "--grid-bits", "1 to 21");
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
  contradiction("--preset paper --effort 3", "--effort", "--preset default");
  contradiction("--fit paper --effort 3", "--effort", "--fit hierarchical");
  contradiction("--fit hierarchical --cross-validate off --frame auto", "--frame auto",
                "--cross-validate on");
  contradiction("--fit hierarchical --environment-radius 1", "--environment-radius", "2 to 1e");
  expect_failure(slf("encode a -o b --preset best"), 2, "--preset", "default|paper");
  expect_failure(slf("encode a -o b --metadata nothing"), 2, "--metadata", "KEY=VALUE");
  expect_failure(slf("encode a -o - --json"), 2, "--json", "standard output");
  expect_failure(slf("render a -o b.png --size 0x5"), 2, "--size", "WxH");
  expect_failure(slf("render a -o b.png --background 1,2,256"), 2, "--background", "0 to 255");
  expect_failure(slf("render a -o b.png --orbit 3"), 2, "b.png", "%d");
  expect_failure(slf("decode a"), 2, "--output", "missing");
}

TEST_F(PackTest, IntegersComeBackAsTheyWere) {
  const Ran packed = slf("pack positions.npy components.npy -o a.slf --step 1 --json");
  ASSERT_EQ(packed.code, 0) << packed.err;
  EXPECT_EQ(parsed(packed.out)["points"], 4);
  EXPECT_EQ(parsed(packed.out)["bytes"], read("a.slf").size());
  EXPECT_EQ(parsed(packed.out)["grid_bits"], 3) << "what the coordinate 7 needs";
  const Ran decoded = slf("decode a.slf --dump dump -o a.ply");
  ASSERT_EQ(decoded.code, 0) << decoded.err;
  EXPECT_EQ(read("dump/positions.npy"), read("positions.npy"));
  const std::string bytes = read("dump/components.npy");
  const auto components = tools::parse_npy({bytes.begin(), bytes.end()});
  ASSERT_TRUE(components);
  const auto values = tools::int32_values(*components);
  ASSERT_EQ(values->size(), components_.size());
  // The transform rounds; a step of 1 keeps every integer within 1 of what it was.
  for (std::size_t i = 0; i < components_.size(); ++i)
    EXPECT_NEAR((*values)[i], components_[i], 1) << i;
  EXPECT_EQ(parsed(read("dump/light_field.json"))["has_basis"], false);
}

TEST_F(PackTest, DashIsStandardInputAndOutput) {
  ASSERT_EQ(slf("pack positions.npy -o a.slf").code, 0);
  const Ran piped = slf("pack - -o - <positions.npy");
  EXPECT_EQ(piped.code, 0);
  EXPECT_EQ(piped.out, read("a.slf"));
  const Ran ply = slf("decode - -o - <a.slf");
  EXPECT_EQ(ply.code, 0);
  EXPECT_EQ(ply.out.rfind("ply\n", 0), 0u);
  EXPECT_EQ(slf("info - <a.slf").code, 0);
}

TEST_F(PackTest, StepsAndGroupsAreThoseOfTheFiles) {
  const std::vector<std::int32_t> steps{2, 3, 4, 5, 6, 7}, groups{0, 1};
  write("steps.npy", text_of(npy_file({2, 3}, std::span<const std::int32_t>(steps))));
  write("groups.npy", text_of(npy_file({2}, std::span<const std::int32_t>(groups))));
  ASSERT_EQ(slf("pack positions.npy components.npy -o a.slf --steps steps.npy --groups groups.npy "
                "--levels 2,3 --grid-bits 3")
                .code,
            0);
  const auto info = parsed(slf("info a.slf --json").out);
  EXPECT_EQ(info["step"], nlohmann::json::parse("[[2,3,4],[5,6,7]]"));
  EXPECT_EQ(info["group"], nlohmann::json::parse("[0,1]"));
  EXPECT_EQ(info["bytes_by_type"].contains("index"), true);
  const auto plain = slf("pack positions.npy components.npy -o b.slf --no-index --no-digest");
  ASSERT_EQ(plain.code, 0);
  const auto types = parsed(slf("info b.slf --json").out)["bytes_by_type"];
  EXPECT_FALSE(types.contains("index"));
  EXPECT_FALSE(types.contains("digest"));
}

TEST_F(PackTest, RefusesArraysThatDoNotFitTogether) {
  const std::vector<std::int32_t> twice{1, 1, 1, 1, 1, 1}, outside{0, 0, -1};
  write("twice.npy", text_of(npy_file({2, 3}, std::span<const std::int32_t>(twice))));
  write("outside.npy", text_of(npy_file({1, 3}, std::span<const std::int32_t>(outside))));
  write("bad.npy", "\x93NUMPY");
  write("real.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n0.5 1 2\n");
  expect_failure(slf("pack twice.npy -o a.slf"), 4, "twice.npy", "stands where another does");
  expect_failure(slf("pack outside.npy -o a.slf"), 4, "outside.npy", "grid");
  expect_failure(slf("pack positions.npy -o a.slf --grid-bits 2"), 4, "positions.npy", "grid");
  expect_failure(slf("pack components.npy -o a.slf"), 4, "components.npy", "[points, 3]");
  expect_failure(slf("pack positions.npy positions.npy -o a.slf"), 4, "positions.npy",
                 "components");
  expect_failure(slf("pack bad.npy -o a.slf"), 4, "bad.npy", ".npy");
  expect_failure(slf("pack real.ply -o a.slf"), 4, "real.ply", "whole numbers");
  expect_failure(slf("pack missing.npy -o a.slf"), 3, "missing.npy", "No such file");
  expect_failure(slf("pack positions.npy components.npy -o a.slf --steps positions.npy"), 4,
                 "positions.npy", "steps");
  EXPECT_FALSE(exists("a.slf"));
}

TEST_F(TinyCaptureTest, EveryVerbAgreesOnWhatWasEncoded) {
  const Ran encoded =
      slf("encode tiny -o a.slf --grid-bits 6 --fit paper --functions 32 --normal-bits 6 "
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
  std::uint64_t bytes = 8;  // the signature
  for (const auto& [type, of_type] : info["bytes_by_type"].items())
    bytes += of_type.get<std::uint64_t>();
  EXPECT_EQ(bytes, report["bytes"]);
  std::map<std::string, std::string> metadata;
  for (const auto& pair : info["metadata"]) metadata[pair["key"]] = pair["value"];
  EXPECT_EQ(metadata["source"], "tiny") << "never more of a path than its last name";
  EXPECT_EQ(metadata["title"], "can");
  EXPECT_EQ(metadata["functions"], "32");

  ASSERT_EQ(slf("decode a.slf -o a.ply --dump dump").code, 0);
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

TEST_F(TinyCaptureTest, EvalTellsApartWhatPicturesLose) {
  const std::string how = " --grid-bits 6 --fit paper --functions 8";
  ASSERT_EQ(slf("encode tiny -o a.slf -q 64" + how).code, 0);
  ASSERT_EQ(slf("encode tiny -o fine.slf -q 0.05" + how).code, 0);
  const auto quality =
      parsed(slf("eval a.slf tiny --unquantised fine.slf --error-map maps --json").out);
  for (const char* cameras : {"input", "held_out"}) {
    const auto& gap = quality[cameras]["gap"];
    EXPECT_GT(gap["points_unquantised"], gap["points_quantised"]) << cameras;
    EXPECT_GT(gap["pictures_unquantised"], gap["pictures_quantised"]) << cameras;
    EXPECT_EQ(gap["points_quantised"], quality[cameras]["points"][0]["psnr"]);
    EXPECT_EQ(gap["pictures_quantised"], quality[cameras]["image"]["psnr"]);
    double sum = 0;
    for (const auto& [step, share] : gap["error_share"].items()) sum += share.get<double>();
    EXPECT_NEAR(sum, 1, 1e-9);
    EXPECT_GT(quality[cameras]["image"]["all"]["ms_ssim"], 0.3);
    EXPECT_EQ(quality[cameras]["image"]["regions"].size(), 3u);
  }
  const std::size_t cameras = quality["input"]["cameras"].get<std::size_t>() +
                              quality["held_out"]["cameras"].get<std::size_t>();
  std::size_t maps = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path("maps")))
    maps += entry.path().extension() == ".png";
  EXPECT_EQ(maps, cameras) << "one of every camera, and nothing half written beside them";
  const std::string said = slf("eval a.slf tiny --unquantised fine.slf").out;
  EXPECT_NE(said.find("splatting"), std::string::npos) << said;
  expect_failure(slf("eval a.slf tiny --min-image-psnr 200 >/dev/null"), 8, "a.slf", "image PSNR");
  EXPECT_EQ(slf("eval a.slf tiny --min-image-psnr 5").code, 0);
  EXPECT_EQ(slf("eval a.slf tiny --no-images --min-image-psnr 5").code, 2);
  expect_failure(slf("eval a.slf tiny --unquantised nowhere.slf"), 3, "nowhere.slf", "");
}

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

TEST_F(TinyCaptureTest, EvalReadsIgcFiles) {
  const auto coded =
      slf("igc tiny -o a.igc --grid-bits 6 --functions 8 --qp 22 --speed fast --json");
  if (coded.code == 6) GTEST_SKIP() << "SLF_X265 is not part of this build";
  ASSERT_EQ(coded.code, 0) << coded.err;
  const auto report = parsed(coded.out);
  const auto quality = parsed(slf("eval a.igc tiny --json --no-images").out);
  EXPECT_EQ(quality["bytes"], report["bytes"]);
  EXPECT_EQ(quality["bytes_by_type"], report["bytes_by_type"]);
  EXPECT_EQ(quality["points"], report["points"]);
  EXPECT_GT(quality["held_out"]["points"][0]["psnr"], 15);
  for (const char* stage : {"geometry", "images", "observe", "fit", "total"})
    EXPECT_GT(quality["decode"][stage], 0) << stage;
  expect_failure(slf("eval a.igc nowhere"), 3, "nowhere", "");
}

TEST_F(TinyCaptureTest, RendersOrbitsCamerasPairsAndSheets) {
  ASSERT_EQ(slf("encode tiny -o a.slf --grid-bits 6 --functions 8").code, 0);
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

TEST_F(TinyCaptureTest, SameBytesForAnyNumberOfThreads) {
  for (const char* threads : {"1", "2", "7"})
    ASSERT_EQ(
        slf(std::string("encode tiny --grid-bits 6 -o ") + threads + ".slf -j " + threads).code, 0);
  EXPECT_EQ(read("1.slf"), read("2.slf"));
  EXPECT_EQ(read("1.slf"), read("7.slf"));
}

TEST_F(TinyCaptureTest, OptionsOverrideThePresetWhateverTheirOrder) {
  const auto settings = [&](const std::string& options) {
    EXPECT_EQ(slf("encode tiny --grid-bits 5 -o a.slf " + options).code, 0) << options;
    std::map<std::string, std::string> metadata;
    const auto info = parsed(slf("info a.slf --json").out);
    for (const auto& pair : info["metadata"]) metadata[pair["key"]] = pair["value"];
    metadata["coder"] = info["coefficient_coder"];
    return metadata;
  };
  const auto paper = settings("--preset paper");
  EXPECT_EQ(paper.at("steps"), "uniform");
  EXPECT_EQ(paper.at("penalise_dc"), "yes");
  EXPECT_EQ(paper.at("coder"), "independent");
  const auto changed = settings("--steps by-norm --free-dc -q 8 --preset paper");
  EXPECT_EQ(changed.at("steps"), "by-norm");
  EXPECT_EQ(changed.at("penalise_dc"), "no");
  EXPECT_EQ(changed.at("q"), "8");
  EXPECT_EQ(changed.at("coder"), "independent");
}

TEST_F(TinyCaptureTest, PartsOfAFileDecode) {
  ASSERT_EQ(slf("encode tiny -o a.slf --grid-bits 6").code, 0);
  const auto points = [&](const std::string& options) {
    const Ran ran = slf("decode a.slf -o a.ply --json " + options);
    EXPECT_EQ(ran.code, 0) << ran.err;
    return parsed(ran.out);
  };
  const auto whole = points(""), coarse = points("--levels 4"), smooth = points("--groups 1");
  EXPECT_LT(coarse["points"], whole["points"]);
  EXPECT_EQ(coarse["grid_bits"], 4);
  EXPECT_EQ(smooth["points"], whole["points"]);
  EXPECT_EQ(points("--max-bytes " + std::to_string(read("a.slf").size() / 2))["partial"], true);
  expect_failure(slf("decode a.slf -o b.ply --levels 7"), 2, "a.slf", "that many");
  EXPECT_FALSE(exists("b.ply"));
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

}  // namespace
}  // namespace slf
