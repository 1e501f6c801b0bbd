// SPDX-License-Identifier: Apache-2.0
// Scenes in parts, as a person runs them: plan, encode --part, merge, encode --memory.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <string>

#include "cli_scene_support.h"

namespace slf::cli_scene_test {
namespace {

namespace fs = std::filesystem;
using cli_scene::SceneTest;

TEST_F(SceneTest, AnyDivisionOfTheWorkGivesTheSameFile) {
  const Ran whole = slf(std::string("encode street -o whole.slf --memory 1G") + kSettings);
  ASSERT_EQ(whole.code, 0) << whole.err;
  EXPECT_FALSE(exists("whole.slf.work"));
  ASSERT_EQ(plan().code, 0);
  for (const int parts : {1, 3}) {
    std::string names;
    for (int i = parts; i > 0; --i) {
      const std::string name = "part" + std::to_string(i) + ".slf";
      const Ran ran = part(std::to_string(i) + "/" + std::to_string(parts), name, " -j 1");
      ASSERT_EQ(ran.code, 0) << ran.err;
      names += name + " ";
    }
    ASSERT_EQ(slf("merge " + names + "-o merged.slf --quiet").code, 0);
    EXPECT_EQ(read("merged.slf"), read("whole.slf")) << parts << " parts";
  }
  EXPECT_EQ(slf("decode merged.slf -o merged.ply --strict --quiet").code, 0);
  const auto info = parsed(slf("info merged.slf --json").out);
  EXPECT_GT(info["slices"].get<int>(), 3);
  EXPECT_FALSE(info["partial"].get<bool>());
}

TEST_F(SceneTest, FewPointsAreTwoSlicesAndLookAsTheyDoInOnePiece) {
  const std::string settings = " --effort 1 --degree 3 --grid-bits 9 --surface given";
  ASSERT_EQ(slf("encode street -o parts.slf --quiet --memory 1G" + settings).code, 0);
  ASSERT_EQ(slf("encode street -o piece.slf --quiet" + settings).code, 0);
  ASSERT_EQ(slf("decode parts.slf -o parts.ply --strict --quiet").code, 0);
  EXPECT_EQ(parsed(slf("info parts.slf --json").out)["slices"], 2);
  const auto psnr = [&](const std::string& file) {
    const Ran ran = slf("eval " + file + " street --json");
    return parsed(ran.out)["input"]["points"][0]["psnr"].get<double>();
  };
  EXPECT_NEAR(psnr("parts.slf"), psnr("piece.slf"), 0.5);
}

TEST_F(SceneTest, ThePlanHasTheStepOfAllSlices) {
  ASSERT_EQ(slf("synth terrace -o street --houses 2 --points 15000 --cameras 12 --quiet").code, 0);
  const auto step_of = [&](const std::string& more) {
    const Ran ran = slf("plan street -o plan.json --work work --grid-bits 9 " + more);
    EXPECT_EQ(ran.code, 0) << ran.err;
    std::string q = parsed(read("plan.json"))["settings"].back()[1].get<std::string>();
    EXPECT_NE(ran.err.find("Q " + q + ", "), std::string::npos) << ran.err;
    return q;
  };
  EXPECT_EQ(step_of("--effort 1"), "16") << "nothing is fitted to pictures";
  const std::string q = step_of("--effort 2 --slice-points 2500 --quality-loss 0.2");
  ASSERT_EQ(part("1/1", "part.slf").code, 0);
  ASSERT_EQ(slf("merge part.slf -o merged.slf --quiet").code, 0);
  const auto info = parsed(slf("info merged.slf --json").out);
  std::map<std::string, std::string> metadata;
  for (const auto& pair : info["metadata"]) metadata[pair["key"]] = pair["value"];
  EXPECT_EQ(metadata["q"], q);
  EXPECT_EQ(metadata["quality_loss"], "0.2");
}

TEST_F(SceneTest, APlanIsTheSameForAnyNumberOfThreads) {
  ASSERT_EQ(plan().code, 0);
  const std::string first = read("plan.json");
  ASSERT_EQ(slf(std::string("plan street -o plan.json --work other") +
                " --slice-points 2500 --effort 1 --degree 3 --grid-bits 9 -j 1 --quiet")
                .code,
            0);
  EXPECT_EQ(read("plan.json"), first);
}

TEST_F(SceneTest, WhatIsDoneIsNotCodedAgain) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/1", "first.slf").code, 0);
  std::size_t slices = 0;
  fs::path one;
  for (const auto& file : fs::recursive_directory_iterator(path("work")))
    if (file.path().filename().string().starts_with("slice-")) {
      ++slices;
      one = file.path();
    }
  ASSERT_GT(slices, 3u);
  fs::remove(one);
  ASSERT_EQ(part("1/1", "second.slf", " --resume --log log.txt").code, 0);
  EXPECT_EQ(read("second.slf"), read("first.slf"));
  const std::string log = read("log.txt");
  const std::size_t coded =
      log.find(": slice ") == std::string::npos ? log.find(" slice ") : log.find(": slice ");
  ASSERT_NE(coded, std::string::npos) << log;
  EXPECT_EQ(log.find(" slice ", coded + 1), std::string::npos) << log;
}

TEST_F(SceneTest, ADirectoryWithoutItsPointsIsFilledFromTheCapture) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/2", "here.slf").code, 0);
  fs::remove_all(path("work"));
  ASSERT_EQ(part("1/2", "there.slf").code, 0);
  EXPECT_EQ(read("there.slf"), read("here.slf"));
}

TEST_F(SceneTest, AnotherCaptureThanThatOfThePlanIsRefused) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/2", "a.slf").code, 0);
  const auto cameras = parsed(read("street/cameras.json"));
  const std::string first = cameras["splits"]["dense"][0].get<std::string>();
  const std::string photograph = read("street/" + first);
  const auto refused = [&] {
    expect_failure(part("2/2", "b.slf"), 4, "street", "not those of the plan");
    EXPECT_FALSE(exists("b.slf"));
  };
  write("street/" + first, photograph + " ");
  refused();
  write("street/" + first, photograph);
  auto moved = cameras;
  moved["cameras"][0]["t"][0] = moved["cameras"][0]["t"][0].get<double>() + 0.01;
  write("street/cameras.json", moved.dump());
  refused();
  write("street/cameras.json", cameras.dump());
  EXPECT_EQ(part("2/2", "b.slf").code, 0);
}

TEST_F(SceneTest, PhotographsAreReadNoLargerThanPointsNeed) {
  ASSERT_EQ(slf("synth terrace -o large --houses 1 --points 15000 --cameras 6 --size 480x360 "
                "--quiet")
                .code,
            0);
  const std::string settings =
      " --slice-points 2500 --effort 1 --degree 2 --grid-bits 7 --work work --quiet";
  ASSERT_EQ(slf("plan large -o plan.json" + settings).code, 0);
  const auto reduction = parsed(read("plan.json"))["reduction"].get<std::vector<int>>();
  EXPECT_EQ(reduction.size(), 6u);
  EXPECT_GT(*std::max_element(reduction.begin(), reduction.end()), 0);
  const auto held_out = [&](const std::string& file) {
    EXPECT_EQ(slf("encode large --plan plan.json --work work --quiet -o " + file).code, 0);
    const auto eval = parsed(slf("eval " + file + " large --json").out);
    return eval["held_out"]["image"]["psnr"].get<double>();
  };
  const double small = held_out("small.slf");
  std::string plan = read("plan.json");
  const std::size_t begin = plan.find("\"reduction\": ["), end = plan.find(']', begin);
  plan.replace(begin, end - begin, "\"reduction\": [0,0,0,0,0,0");
  write("plan.json", plan);
  EXPECT_GT(small, held_out("whole.slf") - 0.1);
}

TEST_F(SceneTest, AMeshHasThePointsThatItHasInOnePiece) {
  ASSERT_EQ(slf("synth can -o can --mesh --size 48x48 --circles 5 --per-circle 8 --quiet").code, 0);
  const std::string how = "encode can --points can/mesh.obj --effort 1 --degree 2 --quiet ";
  const auto points = [&](const std::string& file) {
    return parsed(slf("info " + file + " --json").out)["points"].get<int>();
  };
  ASSERT_EQ(slf(how + "--grid-bits 7 -o piece.slf").code, 0);
  ASSERT_EQ(slf(how + "--grid-bits 7 --memory 1G -o parts.slf").code, 0);
  EXPECT_EQ(points("parts.slf"), points("piece.slf"));
  ASSERT_EQ(slf(how + "-o piece.slf").code, 0);  // at the photographs' density
  ASSERT_EQ(slf(how + "--memory 1G -o parts.slf").code, 0);
  EXPECT_EQ(points("parts.slf"), points("piece.slf"));
}

TEST_F(SceneTest, PlansShareADirectory) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/2", "first.slf").code, 0);
  const std::string settings = " --slice-points 2500 --effort 1 --degree 3 --grid-bits 8 --quiet";
  ASSERT_EQ(slf("plan street -o coarse.json --work work" + settings).code, 0);
  fs::remove(path("street/points.ply"));  // the directory has what both need
  ASSERT_EQ(part("1/2", "second.slf").code, 0);
  EXPECT_EQ(read("second.slf"), read("first.slf"));
  const Ran coarse = slf("encode street --plan coarse.json --work work --part 1/2 -o coarse.slf");
  EXPECT_EQ(coarse.code, 0) << coarse.err;
}

TEST_F(SceneTest, ADryRunSaysWhatItWouldTakeAndWritesNothing) {
  const Ran ran =
      slf(std::string("encode street -o x.slf --dry-run --memory 1G --json") + kSettings);
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto cost = parsed(ran.out);
  for (const char* key : {"points", "slices", "cameras", "memory", "planning_memory", "disk"})
    EXPECT_GT(cost[key].get<std::uint64_t>(), 0u) << key;
  EXPECT_GT(cost["estimated_seconds"].get<double>(), 0);
  EXPECT_FALSE(exists("x.slf"));
  EXPECT_FALSE(exists("x.slf.work"));
}

TEST_F(SceneTest, WrongOptionsSayWhatWouldDo) {
  ASSERT_EQ(plan().code, 0);
  expect_failure(slf("encode street -o x.slf --part 1/2"), 2, "--part", "--plan");
  expect_failure(part("3/2", "x.slf"), 2, "3/2", "I/N");
  expect_failure(part("1/2", "x.slf", " -q 20"), 2, "quality", "plan");
  expect_failure(slf("encode street -o x.slf --plan plan.json --part 1/2"), 2, "--work", "");
  expect_failure(part("1/2", "x.slf", " --split all"), 2, "split", "plan");
  expect_failure(part("1/2", "x.slf", " --metadata a=b"), 2, "metadata", "plan");
  expect_failure(part("1/2", "x.slf", " --up +y"), 2, "up", "plan");
  expect_failure(slf("plan street -o y.json --work work --slice-start shared"), 2, "slice-start",
                 "");
  expect_failure(slf("plan street -o y.json --work work --target-bytes 1000"), 2, "target", "");
  expect_failure(slf("plan street -o y.json --work work --coefficients texture"), 2, "texture", "");
  const Ran little = slf("encode street -o x.slf --memory 256M --grid-bits 9 --fit-to pictures");
  expect_failure(little, 5, "MiB", "more --memory");
  EXPECT_EQ(little.err.find("--slice-points"), std::string::npos) << "smaller ones take as much";
}

TEST_F(SceneTest, ADamagedPlanIsRefusedByItsElement) {
  ASSERT_EQ(plan().code, 0);
  const std::string whole = read("plan.json");
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = whole;
    text.replace(text.find(from), from.size(), to);
    write("plan.json", text);
  };
  with("\"base_levels\": ", "\"base_levels\": 30");
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "base_levels");
  with("\"slices\": [", "\"slices\": [7,7,");
  expect_failure(part("1/1", "x.slf"), 4, "", "");
  with("\"matrix\": [", "\"matrix\": [1.5,");
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "matrix");
  with("\"matrix\": [", "\"matrix\": [1,");
  expect_failure(part("1/1", "x.slf"), 4, "plan", "matrix");
  with("\"groups\": [", "\"groups\": [9,1], \"others\": [");
  expect_failure(part("1/1", "x.slf"), 4, "plan", "groups");
  with("\"rank\": ", "\"rank\": 4");
  expect_failure(part("1/1", "x.slf"), 4, "plan", "rank");
  with("\"colour\": [", "\"colour\": [0,0,0,0,0,0,0,0,0], \"others\": [");
  expect_failure(part("1/1", "x.slf"), 4, "plan", "colours");
  with("[\"block-log2\", \"", "[\"block-log2\", \"9");
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "block-log2");
  with("[\"block-growth\"", "[\"blocks-growth\"");
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "block-growth is expected");
  with("\"trust\": [", "\"trust\": [[0,1,1000,1,1],");
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "trust");
  write("plan.json", whole.substr(0, whole.size() / 2));
  expect_failure(part("1/1", "x.slf"), 4, "plan.json", "");
}

TEST_F(SceneTest, TwoProcessesOnOnePartDoNotDisturbEachOther) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/1", "alone.slf").code, 0);
  fs::remove_all(path("work"));  // the points, too, are made by both
  const std::string one =
      "'" SLF_PROGRAM "' encode street --plan plan.json --work work --quiet -o ";
  const Ran both = shell(one + "a.slf & first=$!; " + one + "b.slf && wait $first");
  ASSERT_EQ(both.code, 0) << both.err;
  ASSERT_EQ(slf("merge alone.slf -o merged.slf --quiet").code, 0);
  EXPECT_EQ(read("a.slf"), read("merged.slf"));
  EXPECT_EQ(read("b.slf"), read("merged.slf"));
  EXPECT_TRUE(leftovers().empty());
}

TEST_F(SceneTest, APhotographThatDisappearsIsNamedAndNothingIsLost) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/2", "a.slf").code, 0);
  const auto cameras = parsed(read("street/cameras.json"));
  for (const auto& name : cameras["splits"]["dense"])
    fs::remove(path("street/" + name.get<std::string>()));
  const Ran ran = part("2/2", "b.slf");
  EXPECT_NE(ran.code, 0);
  EXPECT_FALSE(exists("b.slf"));
  EXPECT_TRUE(exists("a.slf"));
}

}  // namespace
}  // namespace slf::cli_scene_test
