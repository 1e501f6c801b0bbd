// SPDX-License-Identifier: Apache-2.0
// Notes and metres per unit of slf encode and slf html.
#include "cli_support.h"

namespace slf::cli_notes_test {
namespace {

constexpr const char* kNotes =
    R"({ "version": 1, "annotations": [ { "at": [0, 0, 1], "title": "Rim <3" } ] })";
constexpr const char* kKept = R"({"version":1,"annotations":[{"at":[0,0,1],"title":"Rim <3"}]})";

class CliNotesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth die -o die --size 32x32").code, 0);
    write("notes.json", kNotes);
    write("markup.json", R"({"version":1,"annotations":[{"at":[0,0,1],"title":"<b>Rim</b>"}]})");
  }
  Ran encode(const std::string& more, const std::string& capture = "die") const {
    return slf("encode " + capture + " -o x.slf --effort 1 --grid-bits 5 --quiet " + more);
  }
  nlohmann::json info() const { return parsed(slf("info x.slf --json").out); }
  std::string metadata(const std::string& key) const {
    const nlohmann::json read = info();
    for (const auto& pair : read["metadata"])
      if (pair["key"] == key) return pair["value"];
    return "";
  }
};

TEST_F(CliNotesTest, NotesOfEncodeAreInTheMetadata) {
  ASSERT_EQ(encode("--notes notes.json").code, 0);
  EXPECT_EQ(metadata("notes"), kKept);
  ASSERT_EQ(encode("").code, 0);
  EXPECT_EQ(metadata("notes"), "");
}

TEST_F(CliNotesTest, AnnotateWritesNotesAndScaleIntoAFileThatIsThere) {
  ASSERT_EQ(encode("").code, 0);
  const std::string before = read("x.slf");
  const Ran made = slf("annotate x.slf notes.json -o y.slf --metres-per-unit 0.5");
  ASSERT_EQ(made.code, 0) << made.err;
  ASSERT_EQ(slf("annotate x.slf notes.json -o x.slf --metres-per-unit 0.5 --quiet").code, 0);
  EXPECT_EQ(read("x.slf"), read("y.slf")) << "in place, too";
  EXPECT_EQ(metadata("notes"), kKept);
  EXPECT_EQ(info()["header"]["metres_per_unit"], 0.5);
  ASSERT_EQ(slf("annotate y.slf none --metres-per-unit 0 -o y.slf --quiet").code, 0);
  EXPECT_EQ(read("y.slf"), before) << "what goes again leaves the file that was";
  EXPECT_EQ(slf("annotate x.slf markup.json -o z.slf").code, 4);
  EXPECT_EQ(slf("annotate x.slf -o z.slf").code, 2);
  EXPECT_FALSE(exists("z.slf"));
}

TEST_F(CliNotesTest, AScaleThatIsNoneIsRefused) {
  ASSERT_EQ(encode("").code, 0);
  for (const char* metres : {"nan", "inf", "-1", "1e-300", "1e13"})
    expect_failure(slf("annotate x.slf -o y.slf --metres-per-unit=" + std::string(metres)), 2,
                   "--metres-per-unit", "1e-12 to 1e12");
  EXPECT_FALSE(exists("y.slf"));
  EXPECT_EQ(slf("annotate x.slf -o y.slf --metres-per-unit 0").code, 0);
}

TEST_F(CliNotesTest, WrongOnesAreRefusedByFileAndElementAndLeaveNothing) {
  for (const char* verb : {"encode die -o y.slf --effort 1 --quiet", "html x.slf -o y.html"}) {
    const Ran markup = slf(std::string(verb) + " --notes markup.json");
    if (markup.code == 6) continue;  // a program without the page
    EXPECT_EQ(markup.code, 4) << verb;
    EXPECT_NE(markup.err.find("markup.json: annotations[0].title: has markup, '<b'"),
              std::string::npos)
        << markup.err;
    EXPECT_EQ(slf(std::string(verb) + " --notes none.json").code, 3) << verb;
  }
  const Ran twice = encode("--metadata notes=x");
  EXPECT_EQ(twice.code, 2);
  EXPECT_NE(twice.err.find("--notes FILE checks and keeps them"), std::string::npos) << twice.err;
  EXPECT_FALSE(exists("x.slf") || exists("y.slf") || exists("y.html"));
}

TEST_F(CliNotesTest, ThePageHasNotesAndMetresThatItWasGiven) {
  ASSERT_EQ(encode("").code, 0);
  const Ran page = slf("html x.slf -o x.html --quiet --notes notes.json --metres-per-unit 0.01");
  if (page.code == 6) GTEST_SKIP() << page.err;
  ASSERT_EQ(page.code, 0) << page.err;
  const std::string html = read("x.html");
  EXPECT_NE(html.find(R"("metres":0.01,"notes":{"version":1,"annotations":[{"at":[0,0,1],)"
                      R"("title":"Rim \u003c3"}]})"),
            std::string::npos);
  EXPECT_EQ(slf("html x.slf -o y.html --metres-per-unit 0").code, 2);
}

TEST_F(CliNotesTest, MetresPerUnitAreInTheHeaderOfSurfacesSplatsAndParts) {
  ASSERT_EQ(encode("").code, 0);
  EXPECT_EQ(info()["header"]["metres_per_unit"], 0);
  const std::string metres = "--metres-per-unit 0.001";
  ASSERT_EQ(slf("export x.slf -o die.ply --degree 1 --quiet").code, 0);
  ASSERT_EQ(encode(metres).code, 0);
  EXPECT_EQ(info()["header"]["metres_per_unit"], 0.001);
  ASSERT_EQ(slf("encode die.ply -o x.slf --quiet " + metres).code, 0);
  EXPECT_EQ(info()["header"]["metres_per_unit"], 0.001);
  ASSERT_EQ(encode(metres + " --memory 1G --notes notes.json").code, 0);
  EXPECT_EQ(info()["header"]["metres_per_unit"], 0.001);
  EXPECT_EQ(metadata("notes"), kKept);
  EXPECT_EQ(encode("--metres-per-unit -1").code, 2);
}

}  // namespace
}  // namespace slf::cli_notes_test
