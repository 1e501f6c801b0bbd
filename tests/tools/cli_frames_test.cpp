// SPDX-License-Identifier: Apache-2.0
// A stream of several frames and the verbs: none loses frames without a word.
#include "cli_support.h"
#include "tests/codec/frames_support.h"

namespace slf::cli_frames_test {
namespace {

class CliFramesTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    fields_ = test::fields_of(test::Moves::kAppears, 3, 1);
    for (LightField& field : fields_) {
      field.header.has_basis = true;
      field.header.basis.id = BasisId::kHarmonics;
      field.header.basis.degree = 0;
    }
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
  expect_failure(slf("merge x.slf x.slf -o y.slf --quiet"), 4, "x.slf",
                 "a stream of several frames");
  EXPECT_FALSE(exists("y.slf"));
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
