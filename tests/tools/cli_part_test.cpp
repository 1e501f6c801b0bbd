// SPDX-License-Identifier: Apache-2.0
// Parts of a file through the program: no more is read of it than they need.
#include <array>

#include "cli_support.h"
#include "codec/encoder/assemble.h"
#include "codec/scene_units.h"
#include "conformance/edit_units.h"
#include "slf/decoder.h"

namespace slf::cli_part_test {
namespace {

/// good.slf with a base, an index and several slices.
class PartTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    stream_ = conformance::base_stream(true);
    write("good.slf", {stream_.begin(), stream_.end()});
    info_ = *read_info(stream_);
    ASSERT_GT(info_.num_slices, 2u);
  }

  /// Changes a byte in the middle of the last unit of a kind.
  void damage(const std::string& name, const char* type, int slice, int group = -1) const {
    std::string bytes{stream_.begin(), stream_.end()};
    const auto found = std::find_if(info_.units.rbegin(), info_.units.rend(), [&](const auto& u) {
      return u.type == type && u.slice == slice && (group < 0 || u.group == group);
    });
    ASSERT_NE(found, info_.units.rend());
    bytes[found->offset + found->bytes / 2] ^= 1;
    write(name, bytes);
  }

  /// The stream with a unit before its end that says nothing.
  void write_with_filler(const std::string& name, std::uint64_t payload_bytes) const {
    const Units units = *split_units(stream_);
    const SequenceParameterSet set = *find_sequence(units);
    std::vector<CodedUnit> coded;
    for (const Unit& unit : units.units) {
      if (unit.type == UnitType::kSequence || unit.type == UnitType::kIndex ||
          unit.type == UnitType::kEnd)
        continue;
      coded.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}, {}});
      if (has_ids(unit.type)) coded.back().ids = *read_ids(unit, set);
    }
    coded.push_back({UnitType::kFiller, std::vector<std::uint8_t>(payload_bytes), {}});
    const auto bytes = *assemble(set, coded, find_index(units, set)->value().boxes);
    write(name, {bytes.begin(), bytes.end()});
  }

  /// The box of the first slice, which the last is far from. World and voxels are the same.
  std::string region_of_first() const {
    const VoxelBox& box = *info_.slices.front().box;
    std::string corners;
    for (const Voxel& corner : {box.low, box.high})
      for (const std::int32_t c : corner) corners += (corners.empty() ? "" : ",") + text(c);
    return "--region " + corners;
  }
  static std::string text(std::int32_t number) { return std::to_string(number); }

  std::vector<std::uint8_t> stream_;
  StreamInfo info_;
};

constexpr std::array<const char*, 8> kParts = {"--region 0,0,0,7,7,7",
                                               "--levels 3",
                                               "--levels 1",
                                               "--groups 1",
                                               "--region 3,0,2,9,20,5 --levels 3 --groups 1",
                                               "--max-bytes 3000",
                                               "--layers 1",
                                               "--levels 4"};

/// Standard input is read whole.
TEST_F(PartTest, IsWhatIsDecodedOfTheWhole) {
  for (const std::string part : kParts) {
    for (const std::string verb : {"decode FILE -o out.ply --json", "render FILE -o out.png --json",
                                   "export FILE --mean -o out.ply --json"}) {
      const auto run = [&](const std::string& file, const std::string& before) {
        std::string command = verb;
        const Ran ran = slf(command.replace(command.find("FILE"), 4, file) + " " + part, before);
        EXPECT_EQ(ran.code, 0) << command << part << ran.err;
        nlohmann::json said = parsed(ran.out);
        for (const char* own : {"seconds", "seconds_prepare", "peak_memory", "images"})
          said.erase(own);
        return read("out.ply") + read("out.png") + said.dump() + ran.err;
      };
      EXPECT_EQ(run("good.slf", ""), run("-", "cat good.slf |")) << verb << part;
    }
    const auto dump = [&](const std::string& file, const std::string& before) {
      const Ran ran = slf("decode " + file + " --dump d --quiet " + part, before);
      EXPECT_EQ(ran.code, 0) << part << ran.err;
      return read("d/positions.npy") + read("d/components.npy") + read("d/light_field.json");
    };
    EXPECT_EQ(dump("good.slf", ""), dump("-", "cat good.slf |")) << part;
  }
}

/// What is not read is not seen to be damaged.
TEST_F(PartTest, ARegionReadsNothingOfOtherSlices) {
  const int last = static_cast<int>(info_.num_slices) - 1;
  const std::string region = region_of_first() + " -o out.ply";
  damage("far.slf", "coefficients", last);
  damage("far_points.slf", "geometry", last);
  damage("near.slf", "coefficients", 0, 0);
  const Ran ran = slf("decode good.slf --json " + region);
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_GT(parsed(ran.out)["points"], 100);
  const std::string good = read("out.ply");
  for (const char* far : {"far.slf", "far_points.slf"}) {
    EXPECT_EQ(slf("decode " + std::string(far) + " " + region).code, 0) << far;
    EXPECT_TRUE(read("out.ply") == good) << far;
    std::filesystem::remove(path("out.ply"));
    expect_failure(slf("decode " + std::string(far) + " -o out.ply"), 4, far, "checksum");
    expect_failure(slf("decode - " + region, "cat " + std::string(far) + " |"), 4, "standard input",
                   "checksum");
  }
  expect_failure(slf("decode near.slf " + region), 4, "near.slf", "checksum");
  EXPECT_FALSE(exists("out.ply"));
}

TEST_F(PartTest, GroupsReadNothingOfOthers) {
  damage("fine.slf", "coefficients", 0, info_.num_groups - 1);
  EXPECT_EQ(slf("decode fine.slf --groups 1 --dump d").code, 0);
  EXPECT_EQ(slf("export fine.slf --groups 1 -o out.spz").code, 0);
  EXPECT_EQ(slf("render fine.slf --groups 1 --size 16x16 -o out.png").code, 0);
  expect_failure(slf("decode fine.slf --groups 2 --dump d"), 4, "fine.slf", "checksum");
}

/// Means alone are of the whole file, whose checksums are looked at.
TEST_F(PartTest, MeansOfAllPointsAreNoPart) {
  damage("fine.slf", "coefficients", 0, info_.num_groups - 1);
  expect_failure(slf("decode fine.slf -o out.ply"), 4, "fine.slf", "checksum");
}

/// A file may be larger than the memory, if what is asked of it is not.
TEST_F(PartTest, MemoryHasToHoldWhatIsRead) {
  const std::uint64_t memory = decode_cost(stream_)->memory_most + stream_.size();
  write_with_filler("long.slf", memory);
  const std::string limit = " -j 1 -o out.ply --max-memory " + std::to_string(memory);
  expect_failure(slf("decode long.slf" + limit), 5, "long.slf", "bytes of --max-memory");
  EXPECT_EQ(slf("decode long.slf --levels 3" + limit).code, 0);
  const auto less = " -o out.ply --max-memory " + std::to_string(stream_.size() / 2);
  expect_failure(slf("decode long.slf --levels 3" + less), 5, "long.slf", "bytes of --max-memory");
}

TEST_F(PartTest, FilesThatAreNotWholeSaySoOnce) {
  ASSERT_EQ(slf("truncate good.slf --levels 3 -o cut.slf").code, 0);
  const std::string part = " --region 0,0,0,7,7,7 --levels 2 -o out.ply";
  const Ran ran = slf("decode cut.slf" + part);
  EXPECT_EQ(ran.code, 0) << ran.err;
  const std::string warning = "slf: warning: cut.slf: partial: parts were cut off";
  EXPECT_EQ(ran.err.find(warning), 0u) << ran.err;
  EXPECT_EQ(ran.err.find("warning", warning.size()), std::string::npos) << ran.err;
  expect_failure(slf("decode cut.slf --strict" + part), 4, "cut.slf", "--strict");
  write("short.slf", read("good.slf").substr(0, info_.units.back().offset));
  expect_failure(slf("decode short.slf --strict" + part), 4, "short.slf", "ends before its end");
  EXPECT_EQ(slf("decode good.slf --strict" + part).code, 0);
}

}  // namespace
}  // namespace slf::cli_part_test
