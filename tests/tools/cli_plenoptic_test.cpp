// SPDX-License-Identifier: Apache-2.0
// slf synth --plenoptic, encode, decode and eval of clouds of views.
#include "cli_support.h"

namespace slf::cli_plenoptic_test {
namespace {

class PlenopticCli : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth can --plenoptic 9 --points 3000 -o a.ply").code, 0);
  }
};

TEST_F(PlenopticCli, APlyComesBackExactAsAFileOfTheSameProperties) {
  const Ran encoded = slf("encode a.ply -o a.slf --json");
  ASSERT_EQ(encoded.code, 0) << encoded.err;
  const auto report = parsed(encoded.out);
  EXPECT_EQ(report["as"], "planes");
  EXPECT_EQ(report["exact"], true);
  EXPECT_EQ(report["views"], 9);
  EXPECT_LT(report["bits_per_point"]["colour"], 9 * 24 * 0.6);
  ASSERT_EQ(slf("decode a.slf -o b.ply").code, 0);
  EXPECT_EQ(read("b.ply").size(), read("a.ply").size());
  const auto header = [&](const std::string& name) {
    const std::string text = read(name);
    return text.substr(0, text.find("end_header"));
  };
  EXPECT_EQ(header("b.ply"), header("a.ply"));
  const auto quality = parsed(slf("eval a.slf a.ply --json").out);
  const auto& bits = quality["bits_per_point"];
  EXPECT_GT(bits["geometry"].get<double>() + bits["colour"].get<double>(),
            0.9 * bits["file"].get<double>())
      << "corrections are colour";
  EXPECT_EQ(quality["coded"]["exact"], true);
  EXPECT_EQ(quality["views"].size(), 9u);
  // Exact files are the same again: points are in order now.
  ASSERT_EQ(slf("encode b.ply -o c.slf --quiet").code, 0);
  ASSERT_EQ(slf("decode c.slf -o c.ply --quiet").code, 0);
  EXPECT_EQ(read("c.ply"), read("b.ply"));
}

TEST_F(PlenopticCli, APartOfAFileHasTheColoursThatACutFileHas) {
  for (const std::string as : {"planes", "viewmaps"}) {
    ASSERT_EQ(slf("encode a.ply -o a.slf --quiet --as " + as).code, 0);
    for (const std::string part : {"--levels 5", "--groups 1"}) {
      ASSERT_EQ(slf("decode a.slf -o part.ply --quiet " + part).code, 0);
      ASSERT_EQ(slf("truncate a.slf -o cut.slf --quiet " + part).code, 0);
      ASSERT_EQ(slf("decode cut.slf -o cut.ply --quiet").code, 0);
      EXPECT_NE(read("part.ply").find("_8"), std::string::npos);
      EXPECT_EQ(read("part.ply"), read("cut.ply")) << as << " " << part;
      const auto info = parsed(slf("info cut.slf --json").out);
      const bool corrected = info["units"].dump().find("type 192") != std::string::npos;
      EXPECT_FALSE(corrected && info["partial"].get<bool>()) << "corrections are of the whole";
    }
  }
}

TEST_F(PlenopticCli, HeldOutViewsAreJudgedByThemselves) {
  ASSERT_EQ(slf("encode a.ply -o a.slf --hold-out 3,7 --degree 3 -q 8 --quiet").code, 0);
  const auto quality = parsed(slf("eval a.slf a.ply --json").out);
  EXPECT_EQ(quality["held_out"]["views"], nlohmann::json({3, 7}));
  EXPECT_EQ(quality["coded"]["views"].size(), 7u);
  EXPECT_GT(quality["held_out"]["mean"][0], 15);
  const Ran text = slf("eval a.slf a.ply");
  EXPECT_NE(text.out.find("mean, held out"), std::string::npos) << text.out;
}

TEST_F(PlenopticCli, OneColourAloneIsTakenWhereItIsAskedFor) {
  ASSERT_EQ(slf("encode a.ply -o a.slf --as colour --quiet").code, 0);
  ASSERT_EQ(slf("decode a.slf -o b.ply").code, 0);
  EXPECT_EQ(read("b.ply").find("red_0"), std::string::npos);
}

TEST_F(PlenopticCli, OneViewAndPositionsOfOthersAreSaidWithWhatWouldDo) {
  std::string ply = "ply\nformat ascii 1.0\nelement vertex 2\n";
  for (const char* name : {"x", "y", "z"}) ply += std::string("property int ") + name + "\n";
  for (const char* name : {"red", "green", "blue", "v0_r", "v0_g", "v0_b"})
    ply += std::string("property uchar ") + name + "\n";
  write("one.ply", ply + "end_header\n0 0 0 1 2 3 4 5 6\n1 0 0 1 2 3 4 5 6\n");
  const Ran one = slf("encode one.ply -o one.slf");
  EXPECT_EQ(one.code, 0) << one.err;
  EXPECT_NE(one.err.find("one view"), std::string::npos) << one.err;
  EXPECT_NE(one.err.find("--as colour"), std::string::npos) << one.err;
  write("v.json", "[[1,2,3],[4,5,6]]");
  expect_failure(slf("encode a.ply -o a.slf --views v.json"), 4, "v.json", "give one for each");
}

TEST_F(PlenopticCli, WhatDoesNotFitIsRefused) {
  write("v.json", "[[1,2,3],[4,5,6]]");
  expect_failure(slf("encode a.ply -o a.slf --views v.json"), 4, "v.json", "has 9 views");
  expect_failure(slf("encode a.ply -o a.slf --hold-out 9"), 2, "", "views are 0 to 8");
  expect_failure(slf("encode a.ply -o a.slf --split all"), 2, "--split", "plenoptic cloud");
  expect_failure(slf("encode v.json -o a.slf --as planes"), 2, "v.json", "has no views");
  ASSERT_EQ(slf("synth die --plenoptic 9 --points 3000 -o d.ply").code, 0);
  ASSERT_EQ(slf("encode d.ply -o d.slf --quiet").code, 0);
  expect_failure(slf("eval d.slf a.ply"), 4, "a.ply", "other points");
}

}  // namespace
}  // namespace slf::cli_plenoptic_test
