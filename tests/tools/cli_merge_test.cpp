// SPDX-License-Identifier: Apache-2.0
// Parts that are joined, and those that are not.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "bitstream/units.h"
#include "cli_scene_support.h"

namespace slf::cli_merge_test {
namespace {

/// Parts of the street.
class MergeTest : public cli_scene::SceneTest {};

TEST_F(MergeTest, PartsThatDoNotFitTogetherAreRefusedByName) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("1/2", "a.slf").code, 0);
  ASSERT_EQ(part("2/2", "b.slf").code, 0);
  ASSERT_EQ(part("1/1", "all.slf").code, 0);
  ASSERT_EQ(plan(" -q 30").code, 0);
  ASSERT_EQ(part("2/2", "other.slf").code, 0);
  expect_failure(slf("merge a.slf all.slf -o x.slf"), 4, "all.slf", "a.slf");
  expect_failure(slf("merge b.slf a.slf all.slf -o x.slf"), 4, "all.slf", "slice 0 is in a.slf");
  expect_failure(slf("merge a.slf other.slf -o x.slf"), 4, "other.slf", "another plan");
  expect_failure(slf("merge a.slf -o x.slf"), 4, "merge", "missing");
  expect_failure(slf("merge street/points.ply -o x.slf"), 4, "points.ply", "");
  write("cut.slf", read("b.slf").substr(0, read("b.slf").size() / 2));
  expect_failure(slf("merge a.slf cut.slf -o x.slf"), 4, "cut.slf", "");
  EXPECT_FALSE(exists("x.slf"));
}

/// Behind sound checksums.
TEST_F(MergeTest, APartThatDoesNotDecodeIsRefusedByName) {
  ASSERT_EQ(plan().code, 0);
  for (const char* which : {"1/2", "2/2"})
    ASSERT_EQ(part(which, "part" + std::string(which, 1) + ".slf").code, 0);
  const std::string sound = read("part2.slf");
  const std::vector<std::uint8_t> bytes(sound.begin(), sound.end());
  const Units units = *split_units(bytes);
  std::size_t refused = 0;
  for (const Unit& unit : units.units) {
    if (unit.type != UnitType::kGeometry || unit.payload.size() < 40) continue;
    std::vector<std::uint8_t> payload(unit.payload.begin(), unit.payload.end());
    payload[payload.size() / 2] ^= 0x40;
    std::vector<std::uint8_t> again;
    append_unit(again, unit.type, payload);
    ASSERT_EQ(again.size(), unit.bytes);
    std::string damaged = sound;
    std::copy(again.begin(), again.end(),
              damaged.begin() + static_cast<std::ptrdiff_t>(unit.offset));
    write("damaged.slf", damaged);
    const Ran ran = slf("merge part1.slf damaged.slf -o x.slf");
    if (ran.code == 0) {
      EXPECT_EQ(slf("decode x.slf -o x.ply").code, 0);
      std::filesystem::remove(path("x.slf"));
      continue;
    }
    expect_failure(ran, 4, "damaged.slf", "");
    EXPECT_FALSE(exists("x.slf"));
    ++refused;
  }
  EXPECT_GT(refused, 0u);
}

TEST_F(MergeTest, PartsThatWereCutAreSaidToBeSo) {
  ASSERT_EQ(plan().code, 0);
  for (const char* which : {"1/2", "2/2"})
    ASSERT_EQ(part(which, "part" + std::string(which, 1) + ".slf").code, 0);
  for (const char* how : {"--levels 7", "--groups 1", "--region 0,0,0,0.001,0.001,0.001"}) {
    ASSERT_EQ(slf("truncate part2.slf -o cut.slf --quiet " + std::string(how)).code, 0);
    expect_failure(slf("merge part1.slf cut.slf -o x.slf"), 4, "cut.slf", "it was cut");
  }
  const std::string whole = read("part2.slf");
  const Units units = *split_units(std::vector<std::uint8_t>(whole.begin(), whole.end()));
  for (std::size_t u = 3; u < units.units.size(); u += 4) {
    write("cut.slf", whole.substr(0, static_cast<std::size_t>(units.units[u].offset)));
    expect_failure(slf("merge part1.slf cut.slf -o x.slf"), 4, "cut.slf", "it was cut");
  }
  EXPECT_FALSE(exists("x.slf"));
}

TEST_F(MergeTest, TheScaleOfAPartIsThatOfTheSceneInAnyOrder) {
  ASSERT_EQ(plan().code, 0);
  for (const char* which : {"1/2", "2/2"})
    ASSERT_EQ(part(which, "part" + std::string(which, 1) + ".slf").code, 0);
  for (const char* n : {"1", "2"})
    ASSERT_EQ(
        slf("annotate part2.slf --quiet --metres-per-unit " + std::string(n) + " -o m" + n + ".slf")
            .code,
        0);
  for (const char* order : {"part1.slf m2.slf", "m2.slf part1.slf"}) {
    ASSERT_EQ(slf("merge -o x.slf --quiet " + std::string(order)).code, 0);
    EXPECT_EQ(parsed(slf("info x.slf --json").out)["header"]["metres_per_unit"], 2.0) << order;
  }
  ASSERT_EQ(slf("annotate part1.slf --quiet --metres-per-unit 1 -o m1.slf").code, 0);
  expect_failure(slf("merge m1.slf m2.slf -o y.slf"), 4, "m2.slf", "metres_per_unit");
}

TEST_F(MergeTest, MissingPartsLeaveAValidPartialScene) {
  ASSERT_EQ(plan().code, 0);
  ASSERT_EQ(part("2/3", "b.slf").code, 0);
  const Ran merged = slf("merge b.slf -o some.slf --allow-missing --json");
  ASSERT_EQ(merged.code, 0) << merged.err;
  EXPECT_GT(parsed(merged.out)["missing_slices"].size(), 1u);
  EXPECT_EQ(slf("decode some.slf -o some.ply --quiet").code, 0);
  EXPECT_TRUE(parsed(slf("info some.slf --json").out)["partial"].get<bool>());
  // A part by itself is one, too.
  EXPECT_EQ(slf("decode b.slf -o part.ply --quiet").code, 0);
  EXPECT_EQ(read("part.ply"), read("some.ply"));
}

}  // namespace
}  // namespace slf::cli_merge_test
