// SPDX-License-Identifier: Apache-2.0
// slf eval: what it measures, on which cameras, and where it says no.
#include "cli_support.h"

namespace slf::cli_eval_test {
namespace {

TEST_F(TinyCaptureTest, EvalTellsApartWhatPicturesLose) {
  const std::string how = " --surface given --grid-bits 6 --fit paper --functions 8";
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

TEST_F(TinyCaptureTest, PhotographsThatWereDroppedAreNotMeasured) {
  ASSERT_EQ(slf("synth can -o cans --size 96x96 --circles 5 --per-circle 10 --points 8000").code,
            0);
  std::filesystem::copy_file(path("cans/images/0030.png"), path("cans/images/0008.png"),
                             std::filesystem::copy_options::overwrite_existing);
  const Ran ran = slf("encode cans --split all --surface given --effort 1 -q 8 -o cans.slf");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_NE(ran.err.find("0008.png: dropped"), std::string::npos) << ran.err;
  EXPECT_NE(ran.err.find("cameras       49 of the capture's 50, 1 dropped"), std::string::npos)
      << ran.err;
  const auto of_file = parsed(slf("eval cans.slf cans --json").out)["input"],
             of_all = parsed(slf("eval cans.slf cans --split all --json").out)["input"];
  EXPECT_NE(slf("eval cans.slf cans").err.find("were input"), std::string::npos);
  EXPECT_EQ(of_file["cameras"], 49);
  EXPECT_EQ(of_all["cameras"], 50);
  EXPECT_NE(of_file["image"]["psnr"], of_all["image"]["psnr"]);
}

TEST_F(TinyCaptureTest, ASplitThatIsAskedForDoesNotMakeInputOfPhotographs) {
  ASSERT_EQ(slf("encode tiny -o a.slf -q 32 --grid-bits 6 --surface given --effort 1").code, 0);
  for (const char* split : {"all", "evaluation"}) {
    const Ran ran = slf("eval a.slf tiny --split " + std::string(split));
    EXPECT_EQ(ran.code, 0) << ran.err;
    EXPECT_EQ(ran.err.find("were input"), std::string::npos) << ran.err;
  }
}

TEST_F(TinyCaptureTest, EvalMeasuresAFrameByItsOwnBytes) {
  std::filesystem::create_directory(path("moves"));
  for (const char* frame : {"moves/frame_0001", "moves/frame_0002"})
    std::filesystem::copy(path("tiny"), path(frame), std::filesystem::copy_options::recursive);
  ASSERT_EQ(slf("encode moves -o m.slf -q 32 --grid-bits 6 --fit paper --functions 8").code, 0);
  std::vector<nlohmann::json> measured;
  for (const char* frame : {"0", "1"})
    measured.push_back(parsed(slf("eval m.slf tiny --json --frame " + std::string(frame)).out));
  const auto psnr = [](const nlohmann::json& m) {
    return m["input"]["image"]["psnr"].get<double>();
  };
  EXPECT_NEAR(psnr(measured[0]), psnr(measured[1]), 0.05);
  const auto bytes = [](const nlohmann::json& m) { return m["bytes"].get<std::size_t>(); };
  EXPECT_LT(4 * bytes(measured[1]), bytes(measured[0])) << "it stands still";
  EXPECT_EQ(bytes(measured[0]) + bytes(measured[1]), read("m.slf").size());
  expect_failure(slf("eval m.slf tiny --frame 2"), 2, "m.slf", "it has 2");
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
  EXPECT_EQ(quality["settings"]["codec"], "hevc");
  EXPECT_EQ(quality["settings"]["fit"], "paper");
  EXPECT_GE(quality["decode"]["threads"], 1);
  expect_failure(slf("eval a.igc nowhere"), 3, "nowhere", "");
  const Ran few = slf("eval a.igc tiny --max-points 10");
  expect_failure(few, 5, "a.igc", "larger than the decoder's limits (max_points)");
  EXPECT_EQ(few.err.find("kLimit"), std::string::npos) << few.err;
}

}  // namespace
}  // namespace slf::cli_eval_test
