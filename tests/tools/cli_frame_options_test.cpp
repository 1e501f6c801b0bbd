// SPDX-License-Identifier: Apache-2.0
// slf encode of frames: every option of the verb acts on them or is refused by name.
#include <set>
#include <sstream>

#include "cli_support.h"

namespace slf::cli_frame_options_test {
namespace {

namespace fs = std::filesystem;

enum class Frames : std::uint8_t {
  kAct,      ///< the file is another one
  kRefused,  ///< with exit code 2, by name and with what would do
};
using enum Frames;

struct Example {
  std::string option, value;
  Frames clouds = kAct, captures = kAct;
  std::string beside = {};  ///< options without which it would have nothing to act on
  std::string take = "take";
};

/// Options that leave the file as it is: they say where, how fast and how loud.
const std::set<std::string> kBesideTheFile = {"help",  "output", "threads",
                                              "quiet", "json",   "dry-run"};
/// That the paper's fit leaves out the mean: which is so unless --penalise-dc is given.
const std::set<std::string> kRestated = {"free-dc"};

std::vector<Example> inputs() {
  return {{"points", "other.ply", kRefused},
          {"points-world", "x,y,z,0.9", kRefused},
          {"images", "photographs", kRefused},
          {"crop", "-9,-9,-9,40,0.1,40"},
          {"crs", "site.prj"},
          {"split", "all", kRefused},
          {"up", "+x"},
          {"metadata", "who=me"},
          {"notes", "notes.json"},
          {"memory", "300M", kRefused, kRefused},
          {"work", "w", kRefused, kRefused},
          {"log", "l", kRefused, kRefused},
          {"plan", "p", kRefused, kRefused},
          {"resume", "", kRefused, kRefused},
          {"part", "1/2", kAct, kAct, "--group 1"},
          {"as", "planes", kRefused, kRefused},
          {"views", "v.json", kRefused, kRefused},
          {"hold-out", "1", kRefused, kRefused},
          {"frames", "1:1"},
          {"group", "1"},
          {"rate", "10"},
          {"refit-still", "", kRefused}};
}

std::vector<Example> geometry_and_coding() {
  return {{"linear", ""},
          {"preset", "paper", kRefused, kRefused},
          {"effort", "2", kRefused},
          {"grid-bits", "5"},
          {"voxel-size", "0.15"},
          {"densify", "on", kRefused, kRefused},
          {"surface", "mended", kRefused, kRefused},
          {"surface", "splats", kRefused},
          {"splats", "300", kRefused, kAct, "--surface splats"},
          {"surface-seconds", "3", kRefused, kRefused},
          {"surface-memory", "99", kRefused, kRefused},
          {"photograph-pixels", "0.0002", kRefused},
          {"geometry", "draco", kRefused, kRefused},
          {"metres-per-unit", "2"},
          {"quality", "5"},
          {"quality-loss", "9", kRefused, kAct, "--effort 2"},
          {"target-bytes", "3000", kRefused, kRefused},
          {"target-bitrate", "60000"},
          {"target-psnr", "30", kRefused, kRefused},
          {"steps", "uniform"},
          {"coefficients", "independent", kRefused, kRefused},
          {"colour", "none"},
          {"klt", "joint"},
          {"chroma-step", "2"},
          {"predict", "off"},
          {"reference-contexts", "off"},
          {"rdo", "0.7"},
          {"quality-layers", "2", kRefused, kRefused},
          {"normal-bits", "6"},
          {"base-levels", "2", kRefused, kRefused},
          {"slice-points", "100", kRefused, kRefused},
          {"slice-start", "apart", kRefused, kRefused},
          {"texture-bits", "8", kRefused, kRefused},
          {"texture-qp", "20", kRefused, kRefused},
          {"texture-mode", "intra", kRefused, kRefused},
          {"texture-preset", "fast", kRefused, kRefused},
          {"texture-lossless", "", kRefused, kRefused}};
}

std::vector<Example> view_maps() {
  return {{"delta", "60", kRefused},
          {"occlusion-resolution", "0.1", kRefused},
          {"depth-tolerance", "0", kRefused},
          {"match-exposure", "on", kRefused, kRefused},
          {"refine-cameras", "on", kRefused, kRefused},
          {"check-cameras", "off", kRefused, kAct, "--split all", "odd"},
          {"fit", "paper", kRefused},
          {"fit-to", "pictures", kRefused},
          {"order", "3", kRefused, kAct, "--fit paper"},
          {"functions", "4", kRefused, kAct, "--fit paper"},
          {"scales", "1,1", kRefused, kAct, "--fit paper"},
          {"lambda", "5", kRefused, kAct, "--fit paper"},
          {"beta", "5", kRefused, kAct, "--fit paper"},
          {"iterations", "1", kRefused, kAct, "--fit paper"},
          {"penalise-dc", "", kRefused, kAct, "--fit paper"},
          {"neighbours", "2", kRefused, kAct, "--fit paper"},
          {"basis", "bspline", kRefused},
          {"directions", "world", kRefused},
          {"cross-validate", "off", kRefused, kAct, "--effort 7"},
          {"degree", "1", kRefused},
          {"block-log2", "4", kRefused},
          {"block-strength", "9", kRefused},
          {"block-growth", "5", kRefused},
          {"point-penalty", "1", kRefused},
          {"point-growth", "5", kRefused},
          {"environment-degree", "8", kRefused, kAct,
           "-q 1 --directions reflected --environment-radius 2"},
          {"environment-radius", "3", kRefused, kAct,
           "-q 1 --directions reflected --environment-degree 8"}};
}

std::vector<Example> examples() {
  std::vector<Example> all = inputs();
  for (const auto& more : {geometry_and_coding(), view_maps()})
    all.insert(all.end(), more.begin(), more.end());
  return all;
}

class FrameOptionsTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    for (int f = 0; f < 2; ++f) write("c_" + std::to_string(f) + ".ply", cloud(f));
    write("other.ply", cloud(1, 0.05F));
    write("notes.json", R"({"version": 1, "annotations": [{"at": [0, 0, 0], "title": "here"}]})");
    write("site.prj", "LOCAL_CS[\"site\", UNIT[\"metre\", 1]]");
    draw("take", "--points 3000 --circles 1 --per-circle 12");
    for (const std::string frame : {"frame_0001", "frame_0002"}) {
      fs::create_directories(path("photographs/" + frame));
      fs::copy(path("take/frame_0002/images"), path("photographs/" + frame + "/images"),
               fs::copy_options::recursive);
    }
    draw("odd", "--points 4000 --circles 3 --per-circle 8");
    for (const std::string frame : {"frame_0001", "frame_0002"})
      fs::copy_file(path("odd/" + frame + "/images/0004.png"),
                    path("odd/" + frame + "/images/0014.png"),
                    fs::copy_options::overwrite_existing);
  }
  void draw(const std::string& name, const std::string& size) {
    const Ran drawn = slf("synth appear --frames 2 --size 96x96 --supersampling 1 --quiet -o " +
                          name + " " + size);
    ASSERT_EQ(drawn.code, 0) << drawn.err;
  }
  /// A sheet that bends from frame to frame.
  static std::string cloud(int f, float scale = 1) {
    std::string rows;
    for (int i = 0; i < 300; ++i) {
      const int x = i % 20, y = i / 20, z = (x * y) % 7 + f;
      for (const int at : {x, y, z}) rows += std::to_string(scale * static_cast<float>(at)) + " ";
      rows += std::to_string(10 * x) + " " + std::to_string(12 * y) + " " +
              std::to_string(90 + 5 * z) + "\n";
    }
    return "ply\nformat ascii 1.0\nelement vertex 300\nproperty float x\nproperty float y\n"
           "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
           "end_header\n" +
           rows;
  }
  std::string coded(const std::string& input, const std::string& options) {
    const Ran ran = slf("encode " + input + " -o x.slf --quiet " + options);
    EXPECT_EQ(ran.code, 0) << options << ": " << ran.err;
    return read("x.slf");
  }
  void expect_acts_or_refused(const std::string& input, const std::string& base, const Example& e,
                              Frames what) {
    const std::string option = "--" + e.option + (e.value.empty() ? "" : "=" + e.value);
    const std::string beside = base + " " + (what == kAct ? e.beside : "");
    SCOPED_TRACE(input + " " + beside + " " + option);
    if (what == kAct) {
      const std::string before = coded(input, beside);
      EXPECT_NE(coded(input, beside + " " + option), before) << "without effect";
      return;
    }
    const Ran ran = slf("encode " + input + " -o y.slf " + base + " " + option);
    expect_failure(ran, 2, "--" + e.option, "for");
    EXPECT_FALSE(exists("y.slf"));
  }
};

std::set<std::string> options_in(const std::string& help) {
  std::set<std::string> names;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t at = line.find("--");
    if (at == std::string::npos || at > 6 || line.rfind("  ", 0) != 0) continue;
    names.insert(line.substr(at + 2, line.find_first_of(" ,", at) - at - 2));
  }
  return names;
}

TEST_F(FrameOptionsTest, EveryOptionOfEncodeActsOnFramesOrIsRefusedByName) {
  std::set<std::string> known = kBesideTheFile;
  known.insert(kRestated.begin(), kRestated.end());
  for (const Example& e : examples()) {
    known.insert(e.option);
    expect_acts_or_refused("c_%d.ply", "", e, e.clouds);
    const bool other = e.option == "effort" || e.option == "fit" ||
                       e.beside.find("--effort") == 0 || e.beside.find("--fit") == 0;
    expect_acts_or_refused(e.take, other ? "" : "--effort 1", e, e.captures);
  }
  EXPECT_EQ(options_in(slf("encode --help").out), known);
}

}  // namespace
}  // namespace slf::cli_frame_options_test
