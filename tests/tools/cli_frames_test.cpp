// SPDX-License-Identifier: Apache-2.0
// A stream of several frames and the verbs: none loses frames without a word.
#include "cli_support.h"
#include "tests/codec/frames_edit.h"

namespace slf::cli_frames_test {
namespace {

class CliFramesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    fields_ = test::drawn_fields_of(test::Moves::kAppears, 3);
    const test::Bytes bytes =
        test::joined(test::coded_frames(fields_, test::frame_parameters(8, 1)));
    write("x.slf", {bytes.begin(), bytes.end()});
  }
  std::vector<LightField> fields_;
};

TEST_F(CliFramesTest, InfoTellsHowMany) {
  const Ran ran = slf("info x.slf --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(parsed(ran.out)["frames"].size(), 3u);
  EXPECT_EQ(slf("info x.slf --syntax --quiet").code, 0);
}

TEST_F(CliFramesTest, InfoHasATableOfFrames) {
  const auto frames = parsed(slf("info x.slf --json").out)["frames"];
  std::uint64_t bytes = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(frames[f]["points"], fields_[f].num_points()) << f;
    const bool predicted = frames[f]["predicted"].get<bool>();
    EXPECT_EQ(frames[f]["reference"], predicted ? nlohmann::json(f - 1) : nlohmann::json());
    bytes += frames[f]["bytes"].get<std::uint64_t>();
  }
  EXPECT_FALSE(frames[0]["predicted"].get<bool>());
  EXPECT_TRUE(frames[1]["predicted"].get<bool>());
  EXPECT_EQ(bytes, read("x.slf").size());
  const std::string text = slf("info x.slf").out;
  EXPECT_NE(text.find("reference        bytes      points"), std::string::npos) << text;
  EXPECT_EQ(text.find("predicted          0"), text.rfind("predicted          0")) << text;
}

TEST_F(CliFramesTest, DecodeTakesTheFirstOrTheOneAskedFor) {
  for (const std::size_t frame : {0u, 1u, 2u}) {
    const std::string option = frame > 0 ? " --frame " + std::to_string(frame) : "";
    const Ran ran = slf("decode x.slf -o x.ply --json --quiet" + option);
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(parsed(ran.out)["points"], fields_[frame].num_points());
  }
  EXPECT_NE(slf("decode x.slf -o y.ply --frame 3").code, 0);
  EXPECT_FALSE(exists("y.ply"));
}

TEST_F(CliFramesTest, FilesWithinADirectoryHaveTheExtensionOfWhatTheyAre) {
  std::filesystem::create_directory(path("all"));
  EXPECT_EQ(slf("decode x.slf --frames 0:1 -o all").code, 0);
  EXPECT_TRUE(std::filesystem::exists(path("all/001.ply")));
}

TEST_F(CliFramesTest, TruncateKeepsFramesThatWereAskedForAndThoseTheyNeed) {
  const Ran ran = slf("truncate x.slf -o y.slf --frames 1:1 --levels 4 --json --quiet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(parsed(slf("info y.slf --json").out)["frames"].size(), 2u);
  for (const char* frame : {"0", "1"}) {
    ASSERT_EQ(slf("decode x.slf -o x.ply --levels 4 --quiet --frame " + std::string(frame)).code,
              0);
    ASSERT_EQ(slf("decode y.slf -o y.ply --quiet --frame " + std::string(frame)).code, 0);
    EXPECT_EQ(read("x.ply"), read("y.ply"));
  }
  expect_failure(slf("truncate x.slf -o z.slf --frames 1:3 --quiet"), 2, "x.slf", "it has 3");
  expect_failure(slf("truncate x.slf -o z.slf --region 0,0,0,1,1,1 --quiet"), 2, "x.slf", "region");
  EXPECT_FALSE(exists("z.slf"));
}

TEST_F(CliFramesTest, MergeRefusesByName) {
  expect_failure(slf("merge x.slf x.slf -o y.slf --quiet"), 4, "x.slf", "is in x.slf too");
  expect_failure(slf("merge x.slf x.slf -o y.slf --quiet --allow-missing"), 2, "merge",
                 "frames follow each other");
  EXPECT_FALSE(exists("y.slf"));
}

TEST_F(CliFramesTest, AppendNamesThePartThatCannotBe) {
  const auto fields = test::drawn_fields_of(test::Moves::kShift, 1);
  const test::Bytes sound = test::coded_frames(fields, test::frame_parameters(8, 1))[0];
  test::Frame units = test::split(sound);
  const auto geometry = std::find_if(units.begin(), units.end(), [](const test::OwnedUnit& u) {
    return u.type == UnitType::kGeometry && u.payload.size() > 30;
  });
  ASSERT_NE(geometry, units.end());
  geometry->payload.resize(geometry->payload.size() / 2);  // behind a sound checksum
  const test::Bytes damaged = test::joined_units(units);
  write("a.slf", {sound.begin(), sound.end()});
  write("b.slf", {damaged.begin(), damaged.end()});
  expect_failure(slf("merge --append a.slf b.slf -o y.slf"), 4, "b.slf", "geometry");
  write("still.slf", "no film");
  expect_failure(slf("merge --append a.slf still.slf -o y.slf"), 4, "still.slf", "");
  expect_failure(slf("merge --append still.slf a.slf -o y.slf"), 2, "still.slf", "is of frames");
  EXPECT_FALSE(exists("y.slf"));
}

TEST_F(CliFramesTest, DamageInALaterFrameIsNotPassedOn) {
  std::string damaged = read("x.slf");
  damaged[damaged.size() - 60] ^= 1;
  write("damaged.slf", damaged);
  expect_failure(slf("annotate damaged.slf --metres-per-unit 1 -o y.slf"), 4, "damaged.slf",
                 "checksum");
  if (const Ran page = slf("html damaged.slf -o y.html"); page.code != 6)  // 6: has no page
    expect_failure(page, 4, "damaged.slf", "checksum");
  EXPECT_FALSE(exists("y.slf"));
  EXPECT_FALSE(exists("y.html"));
}

TEST_F(CliFramesTest, DamageInAnyOfManyGroupsIsNotPassedOn) {
  const auto fields = test::drawn_fields_of(test::Moves::kShift, 40);
  const auto frames = test::coded_frames(fields, test::frame_parameters(8, 1), 2);
  const test::Bytes whole = test::joined(frames);
  std::size_t end = 0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    end += frames[f].size();
    if (f % 3 != 0) continue;
    std::string damaged(whole.begin(), whole.end());
    damaged[end - 60] ^= 1;
    write("damaged.slf", damaged);
    expect_failure(slf("annotate damaged.slf --metres-per-unit 1 -o y.slf"), 4, "damaged.slf",
                   "checksum");
  }
}

TEST_F(CliFramesTest, ARangeBeyondTheEndWritesNothing) {
  for (const char* verb : {"render x.slf --size 9x9 -o v%d.png", "decode x.slf -o v%d.ply"})
    expect_failure(slf(std::string(verb) + " --frames 1:9 --quiet"), 2, "x.slf",
                   "frame 9 is asked for, but it has 3");
  EXPECT_FALSE(exists("v1.png") || exists("v1.ply"));
}

TEST_F(CliFramesTest, EvalOfADirectoryOfFramesNamesOneOfThem) {
  ASSERT_EQ(slf("synth turn --frames 2 --size 16x16 --points 300 --circles 1 --per-circle 2 "
                "-o take --quiet")
                .code,
            0);
  expect_failure(slf("eval x.slf take"), 2, "--frame 0", "take/frame_0001");
}

TEST_F(CliFramesTest, MergeAppends) {
  ASSERT_EQ(slf("merge x.slf x.slf -o y.slf --quiet --append").code, 0);
  EXPECT_EQ(parsed(slf("info y.slf --json").out)["frames"].size(), 6u);
  ASSERT_EQ(slf("decode x.slf -o x.ply --frame 2 --quiet").code, 0);
  ASSERT_EQ(slf("decode y.slf -o y.ply --frame 5 --quiet").code, 0);
  EXPECT_EQ(read("x.ply"), read("y.ply"));
}

/// Clouds NAME_0.ply .. NAME_4.ply, of which 0 and 3 have no vertex.
class CliEmptyFramesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    for (int f = 0; f < 5; ++f) write("walk_" + std::to_string(f) + ".ply", cloud(f));
    ASSERT_EQ(slf("encode walk_%d.ply -o walk.slf --quiet --group 2 -q 4").code, 0);
  }
  static std::string cloud(int f) {
    std::string rows;
    int count = 0;
    for (int i = 0; i < 400 && f != 0 && f != 3; ++i, ++count) {
      const int x = i % 20, y = i / 20, z = (x * y) % 7 + f;
      rows += std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + " " +
              std::to_string(10 * x) + " " + std::to_string(12 * y) + " 90\n";
    }
    return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(count) +
           "\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n"
           "property uchar green\nproperty uchar blue\nend_header\n" +
           rows;
  }
};

TEST_F(CliEmptyFramesTest, AreWrittenAsCloudsWithoutVertices) {
  ASSERT_EQ(slf("decode walk.slf --frames 0:4 -o out%d.ply --quiet").code, 0);
  for (const int f : {0, 3})
    EXPECT_NE(read("out" + std::to_string(f) + ".ply").find("element vertex 0\n"),
              std::string::npos);
  EXPECT_NE(read("out4.ply").find("element vertex 400\n"), std::string::npos);
  const Ran again = slf("encode out%d.ply -o again.slf --json --quiet --group 2 -q 4");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(parsed(again.out)["frames"][3]["points"], 0);
}

TEST_F(CliEmptyFramesTest, ShowTheBackground) {
  ASSERT_EQ(slf("render walk.slf --frames 0:4 -o v%d.png --size 40x30 --background 9,8,7").code, 0);
  EXPECT_EQ(read("v0.png"), read("v3.png"));
  EXPECT_NE(read("v0.png"), read("v4.png"));
  ASSERT_EQ(slf("render walk.slf --frame 3 --orbit 2 --sheet -o s.png --size 40x30 --quiet").code,
            0);
  ASSERT_EQ(slf("render walk.slf -o t.png --size 40x30 --transparent --quiet").code, 0);
}

TEST_F(CliEmptyFramesTest, AreToldByInfoCutByTruncateAndMergedFromParts) {
  const auto info = parsed(slf("info walk.slf --json").out);
  EXPECT_EQ(info["points"], 0);
  EXPECT_EQ(info["bits_per_point"], 0);
  EXPECT_EQ(info["version"], (nlohmann::json{1, 2}));
  EXPECT_EQ(info["frames"].size(), 5u);
  EXPECT_EQ(slf("info walk.slf").code, 0);
  EXPECT_EQ(slf("info walk.slf --syntax").code, 0);
  ASSERT_EQ(slf("truncate walk.slf --frames 2:4 --levels 3 -o cut.slf --quiet").code, 0);
  ASSERT_EQ(slf("decode cut.slf --frame 1 -o cut.ply --quiet").code, 0);
  for (const char* part : {"1/3", "2/3", "3/3"})
    ASSERT_EQ(slf("encode walk_%d.ply -o part" + std::string(1, part[0]) +
                  ".slf --quiet --group 2 -q 4 --part " + part)
                  .code,
              0);
  ASSERT_EQ(slf("merge part3.slf part1.slf part2.slf -o merged.slf --quiet").code, 0);
  EXPECT_EQ(read("merged.slf"), read("walk.slf"));
  EXPECT_EQ(slf("encode walk_%d.ply -o p.slf --quiet --group 2 --part 1/4").code, 2);
}

TEST_F(CliEmptyFramesTest, ExportWritesPointsAndRefusesSplatsByName) {
  ASSERT_EQ(slf("export walk.slf --frame 3 --mean -o e.ply --quiet").code, 0);
  EXPECT_NE(read("e.ply").find("element vertex 0\n"), std::string::npos);
  expect_failure(slf("export walk.slf --frame 3 -o e.glb --quiet"), 4, "walk.slf", "no points");
}

TEST_F(CliFramesTest, HtmlHoldsAllFramesAndHowTheyPlay) {
  const Ran ran = slf("html x.slf -o y.html --quiet --no-poster --no-loop --speed 2 --paused");
  if (ran.err.find("one_file.html") != std::string::npos) GTEST_SKIP() << "built without the page";
  ASSERT_EQ(ran.code, 0) << ran.err;
  const std::string page = read("y.html");
  EXPECT_NE(page.find(shell("base64 -w0 x.slf").out), std::string::npos);
  for (const char* option : {"\"speed\":2.0", "\"loop\":false", "\"paused\":true"})
    EXPECT_NE(page.find(option), std::string::npos) << option;
  ASSERT_EQ(slf("html x.slf -o plain.html --quiet --no-poster").code, 0);
  for (const char* option : {"\"speed\":", "\"loop\":", "\"paused\":"})
    EXPECT_EQ(read("plain.html").find(option), std::string::npos) << option;
  EXPECT_NE(slf("html x.slf -o z.html --quiet --speed 0").code, 0);
}

}  // namespace
}  // namespace slf::cli_frames_test
