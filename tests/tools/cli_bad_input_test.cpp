// SPDX-License-Identifier: Apache-2.0
// Bad input of every kind through the program: one line that names file and cause, the documented
// exit code, no output file, and what was there before survives.
#include <cmath>

#include "bitstream/units.h"
#include "cli_support.h"

namespace slf::cli_bad_input_test {
namespace {

using nlohmann::json;

/// The tiny capture, to be spoilt; a small settings string to keep runs short.
class BadCaptureTest : public TinyCaptureTest {
 protected:
  json cameras() { return parsed(read("tiny/cameras.json")); }
  void set_cameras(const json& content) { write("tiny/cameras.json", content.dump()); }
  void set_points(
      const std::string& body, const std::string& count,
      const char* properties = "property float x\nproperty float y\nproperty float z\n") {
    write("tiny/points.ply", "ply\nformat ascii 1.0\nelement vertex " + count + "\n" + properties +
                                 "end_header\n" + body);
  }
  void expect_refused(int code, const std::string& file, const std::string& cause) {
    write("old.slf", "what was there");
    const Ran ran =
        slf("encode tiny -o old.slf --surface given --grid-bits 5 --functions 8 --quiet");
    expect_failure(ran, code, file, cause);
    EXPECT_TRUE(read("old.slf") == "what was there");
    EXPECT_TRUE(leftovers().empty());
  }
};

TEST_F(BadCaptureTest, MissingCapture) {
  expect_failure(slf("encode nowhere -o a.slf"), 3, "nowhere", "");
  EXPECT_FALSE(exists("a.slf"));
}

TEST_F(BadCaptureTest, MissingOrUnreadableImage) {
  const std::string image = cameras()["splits"]["dense"][0];
  const std::string good = read("tiny/" + image);
  std::filesystem::remove(path("tiny/" + image));
  expect_refused(3, image, "");
  write("tiny/" + image, good.substr(0, good.size() / 2));
  expect_refused(4, image, "");
  write("tiny/" + image, "not an image at all");
  expect_refused(4, image, "");
}

TEST_F(BadCaptureTest, ImageOfAnotherSizeThanCalibrated) {
  json changed = cameras();
  const std::string image = changed["cameras"][0]["image"];
  changed["cameras"][0]["width"] = 49;
  set_cameras(changed);
  expect_refused(4, image, "4");
}

TEST_F(BadCaptureTest, CamerasThatAreNone) {
  const json good = cameras();
  json changed = good;
  for (auto& number : changed["cameras"][1]["R"][0]) number = -number.get<double>();
  set_cameras(changed);
  expect_refused(4, "tiny", "");  // mirrored
  changed = good;
  changed["cameras"][1]["R"][0][0] = changed["cameras"][1]["R"][0][0].get<double>() + 0.5;
  set_cameras(changed);
  expect_refused(4, "tiny", "");  // not orthonormal
  for (const double focal : {0.0, -50.0}) {
    changed = good;
    changed["cameras"][1]["K"][0][0] = focal;
    set_cameras(changed);
    expect_refused(4, "tiny", "");
  }
  write("tiny/cameras.json", "{\"cameras\": [");
  expect_refused(4, "cameras.json", "");
}

TEST_F(BadCaptureTest, NanAndInfinityAnywhere) {
  const json good = cameras();
  std::string text = good.dump();
  const std::size_t t = text.find("\"t\":[");
  ASSERT_NE(t, std::string::npos);
  for (const char* number : {"NaN", "1e999", "null"}) {
    std::string changed = text;
    changed.replace(t + 5, changed.find(',', t) - t - 5, number);
    write("tiny/cameras.json", changed);
    expect_refused(4, "cameras.json", "");
  }
  set_cameras(good);
  set_points("inf 0 0\n1 nan 1\n", "2");  // some are left out, not all
  expect_refused(4, "points.ply", "no points");
}

TEST_F(BadCaptureTest, CloudsThatCannotBeUsed) {
  set_points("0 0 0\n1 1 1\n", "3");
  expect_refused(4, "points.ply", "");
  set_points("0 0 0\n1 1 1\n", "999999999999");
  expect_refused(4, "points.ply", "");
  set_points("", "0");
  expect_refused(4, "tiny", "");
  set_points("1 1 1\n1 1 1\n", "2");
  expect_refused(4, "tiny", "voxel");
  set_points("1000 1000 1000\n1001 1000 1000\n1000 1001 1000\n1000 1000 1001\n", "4");
  expect_refused(4, "tiny", "");  // outside every frustum
}

TEST_F(BadCaptureTest, ASplitWithoutImages) {
  json changed = cameras();
  changed["splits"]["dense"] = json::array();
  set_cameras(changed);
  expect_refused(4, "tiny", "split dense has no images");
}

TEST_F(BadCaptureTest, WhatIsSmallIsNotSaidToBeZero) {
  expect_failure(slf("encode tiny -o x.slf --voxel-size 1e-9 --effort 1 --quiet"), 4, "tiny",
                 "a voxel size of 1e-09");
}

TEST_F(BadCaptureTest, WrongJsonSaysItsCause) {
  std::string text = cameras().dump();
  text.replace(text.find("\"t\":[") + 5, 0, "NaN,");
  write("tiny/cameras.json", text);
  expect_refused(4, "cameras.json", "invalid literal");
}

TEST_F(BadCaptureTest, UnknownSplit) {
  expect_failure(slf("encode tiny -o a.slf --split nonsense --quiet"), 2, "nonsense", "");
}

TEST_F(BadCaptureTest, OutputThatCannotBeWritten) {
  const std::string options = " --surface given --grid-bits 5 --functions 8 --quiet";
  expect_failure(slf("encode tiny -o none/a.slf" + options), 7, "none/a.slf", "does not exist");
  expect_failure(slf("encode tiny -o tiny" + options), 7, "tiny", "directory");
  expect_failure(slf("encode tiny -o /dev/full" + options), 7, "/dev/full", "No space left");
  expect_failure(slf("encode tiny -o - >/dev/full" + options), 7, "standard output",
                 "No space left");
}

TEST_F(BadCaptureTest, AnOutputThatCannotBeWrittenIsRefusedBeforeTheWork) {
  const std::string heavy = " --effort 8 --quiet";  // minutes, if it were begun
  expect_failure(slf("encode tiny -o ''" + heavy), 2, "output", "empty");
  expect_failure(slf("encode tiny -o /proc/x.slf" + heavy), 7, "/proc/x.slf", "not writable");
}

TEST_F(CliTest, StandardOutputIsNoDirectory) {
  expect_failure(slf("synth can -o -"), 2, "standard output", "directory");
  ASSERT_EQ(slf("synth rot1 --frames 2 --bits 5 -o m --quiet").code, 0);
  ASSERT_EQ(slf("encode m -o m.slf --quiet").code, 0);
  expect_failure(slf("decode m.slf --dump -"), 2, "standard output", "directory");
  std::filesystem::create_directory(path("-"));
  expect_failure(slf("render m.slf -o - --frames 0:1 --quiet"), 2, "--output -", "%d");
  EXPECT_TRUE(std::filesystem::is_empty(path("-")));
}

TEST_F(CliTest, AFullDiskLeavesNoPartOfASyntheticCapture) {
  const std::string how = " --size 16x16 --circles 1 --per-circle 2 --points 5000";
  const Ran ran = slf("synth can -o can" + how, "ulimit -f 4;");
  expect_failure(ran, 7, "can", "cannot be written");
  EXPECT_FALSE(exists("can"));
  std::filesystem::create_directory(path("own"));
  write("own/note.txt", "mine");
  EXPECT_EQ(slf("synth can --force -o own" + how, "ulimit -f 4;").code, 7);
  EXPECT_EQ(read("own/note.txt"), "mine");
}

TEST_F(BadCaptureTest, AFullDiskLeavesTheOldFile) {
  write("a.slf", "what was there");
  // A limit on the size of files stands for the disk: write() fails in the middle.
  const Ran ran = slf("encode tiny -o a.slf --surface given --grid-bits 5 --functions 8 --quiet",
                      "ulimit -f 1;");
  expect_failure(ran, 7, "a.slf", "cannot be written");
  EXPECT_EQ(read("a.slf"), "what was there");
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(CliTest, AnInterruptLeavesNoTemporaryFile) {
  const Ran ran = shell("timeout --preserve-status -s INT 0.4 '" SLF_PROGRAM
                        "' synth can -o big --size 512x512 --points 20000");
  EXPECT_EQ(ran.code, 130) << ran.err;
  EXPECT_TRUE(leftovers().empty());
}

class BadStreamTest : public TinyCaptureTest {
 protected:
  void SetUp() override {
    TinyCaptureTest::SetUp();
    ASSERT_EQ(slf("encode tiny -o good.slf --surface given --grid-bits 5 --functions 8").code, 0);
    good_ = read("good.slf");
  }
  void expect_refused(const std::string& stream, int code, const std::string& cause) {
    write("bad.slf", stream);
    for (const char* verb :
         {"info bad.slf", "decode bad.slf -o out.ply", "decode bad.slf --dump out",
          "render bad.slf -o out.png", "eval bad.slf tiny"}) {
      expect_failure(slf(verb), code, "bad.slf", cause);
      EXPECT_FALSE(exists("out.ply") || exists("out.png") || exists("out/light_field.json"))
          << verb;
    }
  }
  std::string good_;
};

TEST_F(BadStreamTest, TruncatedCorruptedForeignAndEmpty) {
  expect_refused(good_.substr(0, good_.size() - 1), 4, "truncated");
  expect_refused(good_.substr(0, good_.size() / 2), 4, "truncated");
  std::string changed = good_;
  changed[changed.size() / 2] = static_cast<char>(changed[changed.size() / 2] ^ 0x10);
  expect_refused(changed, 4, "damaged");
  expect_refused(good_ + "more", 4, "");
  expect_refused(read("tiny/points.ply"), 4, "not an .slf file");
  expect_refused("", 4, "");
}

TEST_F(BadStreamTest, AnotherMajorVersionIsSaidWithBothNumbers) {
  for (const int major : {0, 9}) {
    std::string other = good_;
    other[kSignature.size() + 1] = static_cast<char>(major);  // looked at before the checksum
    other[kSignature.size() + 2] = 4;
    const std::string said = "format " + std::to_string(major) + ".4, where 1.x is read";
    expect_refused(other, 6, said);
    write("other.slf", other);
    expect_failure(slf("merge other.slf -o whole.slf"), 6, "other.slf", said);
  }
}

/// So many lists, or objects, within each other.
std::string deep(const std::string& opened, const std::string& closed = "") {
  std::string text, end;
  for (int i = 0; i < 100000; ++i) {
    text += opened;
    end += closed;
  }
  return text + end;
}

TEST_F(BadStreamTest, JsonThatIsNestedTooDeepNamesItsFileAndTheDepth) {
  constexpr const char* kDeep = "nested deeper than 64";
  for (const std::string& text : {deep("["), deep("[", "]"), deep("{\"a\":"), deep("[{\"a\":[")}) {
    for (const char* name : {"cameras.json", "transforms.json", "sfm_data.json", "any.json"}) {
      write(name, text);
      expect_failure(slf(std::string("encode ") + name + " -o x.slf"), 4, name, kDeep);
    }
    write("x.gltf", text);
    expect_failure(slf("encode tiny --points x.gltf -o x.slf"), 4, "x.gltf", kDeep);
    write("x.plan", text);
    expect_failure(slf("encode tiny --plan x.plan --work w --part 1/2 -o x.slf"), 4, "x.plan",
                   kDeep);
    expect_failure(slf("render good.slf --camera any.json -o x.png"), 4, "any.json", kDeep);
    expect_failure(slf("eval good.slf any.json"), 4, "any.json", kDeep);
  }
  EXPECT_FALSE(exists("x.slf") || exists("x.png"));
}

TEST_F(CliTest, XmlThatIsNestedTooDeepNamesItsFileAndTheDepth) {
  write("x.xml", deep("<a>"));
  expect_failure(slf("encode x.xml -o x.slf"), 4, "x.xml", "nested deeper than 32");
}

TEST_F(CliTest, MissingStream) {
  expect_failure(slf("info none.slf"), 3, "none.slf", "No such file");
  expect_failure(slf("decode . -o a.ply"), 3, ".", "directory");
}

}  // namespace
}  // namespace slf::cli_bad_input_test
