// SPDX-License-Identifier: Apache-2.0
// Every verb that writes a file writes the format that the name promises, or refuses the name.
#include <map>
#include <set>
#include <sstream>

#include "cli_support.h"

namespace slf::cli_formats_test {
namespace {

struct Writer {
  std::string words;    ///< without -o
  std::string formats;  ///< the first in the message
};

/// Verbs with --output that write a file, and how each is called.
const std::map<std::string, Writer>& writers() {
  static const std::map<std::string, Writer> all{
      {"annotate", {"annotate x.slf none", ".slf"}},
      {"decode", {"decode x.slf", ".ply"}},
      {"encode", {"encode tiny --effort 1", ".slf"}},
      {"export", {"export x.slf", ".ply"}},
      {"html", {"html x.slf", ".html"}},
      {"igc", {"igc tiny", ".igc"}},
      {"merge", {"merge x.slf x.slf", ".slf"}},
      {"pack", {"pack p.npy", ".slf"}},
      {"plan", {"plan tiny --work store", ".json"}},
      {"render", {"render x.slf --size 20x20", ".png"}},
      {"synth", {"synth can --plenoptic 4", ".ply"}},
      {"truncate", {"truncate x.slf --levels 4", ".slf"}}};
  return all;
}

class CliFormats : public TinyCaptureTest {
 protected:
  void SetUp() override {
    TinyCaptureTest::SetUp();
    ASSERT_EQ(slf("encode tiny -o x.slf --effort 1 -q 16 --quiet").code, 0);
  }
  /// Verbs of the program whose help has an option --output.
  std::set<std::string> verbs_with_output() const {
    std::set<std::string> verbs;
    std::istringstream lines(slf("--help").out);
    std::string line;
    while (std::getline(lines, line)) {
      std::istringstream words(line);
      std::string verb;
      if (line.rfind("  ", 0) != 0 || line.rfind("   ", 0) == 0 || !(words >> verb)) continue;
      if (verb[0] != '-' && slf(verb + " --help").out.find("--output") != std::string::npos)
        verbs.insert(verb);
    }
    return verbs;
  }
};

TEST_F(CliFormats, EveryVerbThatWritesIsTriedHere) {
  std::set<std::string> tried;
  for (const auto& [verb, writer] : writers()) tried.insert(verb);
  EXPECT_EQ(verbs_with_output(), tried);
}

TEST_F(CliFormats, NoVerbWritesUnderANameThatPromisesAnotherFormat) {
  for (const auto& [verb, writer] : writers())
    for (const std::string name : {"q.pts", "q.csv", "q.las.gz", "q.ply.gz", "q.jxl", "q.ppm",
                                   "q.pdf", "q.PTS", "q.neverseen", "q.2", "q.xhtml"}) {
      SCOPED_TRACE(verb + " -o " + name);
      const Ran ran = slf(writer.words + " -o " + name);
      if (ran.err.find("without the viewer page") != std::string::npos) continue;
      expect_failure(ran, 2, name, writer.formats);
      EXPECT_NE(ran.err.find(verb), std::string::npos) << ran.err;
      EXPECT_FALSE(exists(name));
    }
  EXPECT_FALSE(exists("store"));
}

TEST_F(CliFormats, NamesWithoutAnExtensionAreTaken) {
  EXPECT_EQ(slf("decode x.slf -o decoded").code, 0);
  EXPECT_EQ(read("decoded").substr(0, 3), "ply");
  EXPECT_EQ(slf("render x.slf --size 20x20 -o .hidden").code, 0);
  EXPECT_EQ(read(".hidden").substr(1, 3), "PNG");
  EXPECT_EQ(slf("truncate x.slf --levels 4 -o a.b/cut").code, 7) << "no such directory";
  std::filesystem::create_directory(path("a.b"));
  EXPECT_EQ(slf("truncate x.slf --levels 4 -o a.b/cut").code, 0);
}

TEST_F(CliFormats, AnOptionSaysTheFormatOfANameThatSaysNone) {
  EXPECT_EQ(slf("render x.slf --size 20x20 --format png -o thumbnail.A1b2C3").code, 0);
  EXPECT_EQ(read("thumbnail.A1b2C3").substr(1, 3), "PNG");
  EXPECT_EQ(slf("render x.slf --size 20x20 --format jpg -o -").out.substr(0, 2), "\xFF\xD8");
  EXPECT_EQ(slf("export x.slf --quiet --format spz -o splats.part").code, 0);
  expect_failure(slf("render x.slf --format png -o q.jpg"), 2, "q.jpg", "it writes .png");
  expect_failure(slf("render x.slf --format jpg --transparent -o q"), 2, "--transparent", "PNG");
  expect_failure(slf("render x.slf --format png --orbit 2 -o q.avi"), 2, "q.avi", "--format");
  expect_failure(slf("export x.slf --format spz -o q.ply"), 2, "q.ply", "it writes .spz");
}

}  // namespace
}  // namespace slf::cli_formats_test
