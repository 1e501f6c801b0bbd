// SPDX-License-Identifier: Apache-2.0
// slf pack, and decode --dump: integers in, the same integers out.
#include "cli_support.h"
#include "tools/npy.h"

namespace slf::cli_pack_test {
namespace {

using tools::npy_file;

std::string text_of(const tools::NpyFile& file) {
  return file.head +
         std::string(reinterpret_cast<const char*>(file.elements.data()), file.elements.size());
}

/// positions.npy with four points and components.npy with two functions of them.
class PackTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    write("positions.npy", text_of(npy_file({4, 3}, std::span<const std::int32_t>(positions_))));
    write("components.npy",
          text_of(npy_file({4, 2, 3}, std::span<const std::int32_t>(components_))));
  }
  // In Morton order (x least significant), so that decoding gives the same arrays.
  std::vector<std::int32_t> positions_{0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 6, 7};
  std::vector<std::int32_t> components_{10, -20, 30, 1, 2, 3, 11, -21, 31, 4,  5, 6,
                                        12, -22, 32, 7, 8, 9, 13, -23, 33, 10, 0, -12};
};

TEST_F(PackTest, IntegersComeBackAsTheyWere) {
  const Ran packed = slf("pack positions.npy components.npy -o a.slf --step 1 --json");
  ASSERT_EQ(packed.code, 0) << packed.err;
  EXPECT_EQ(parsed(packed.out)["points"], 4);
  EXPECT_EQ(parsed(packed.out)["bytes"], read("a.slf").size());
  EXPECT_EQ(parsed(packed.out)["grid_bits"], 3) << "what the coordinate 7 needs";
  const Ran decoded = slf("decode a.slf --dump dump -o a.ply");
  ASSERT_EQ(decoded.code, 0) << decoded.err;
  EXPECT_EQ(read("dump/positions.npy"), read("positions.npy"));
  const std::string bytes = read("dump/components.npy");
  const auto components = tools::parse_npy({bytes.begin(), bytes.end()});
  ASSERT_TRUE(components);
  const auto values = tools::int32_values(*components);
  ASSERT_EQ(values->size(), components_.size());
  // The transform rounds; a step of 1 keeps every integer within 1 of what it was.
  for (std::size_t i = 0; i < components_.size(); ++i)
    EXPECT_NEAR((*values)[i], components_[i], 1) << i;
  EXPECT_EQ(parsed(read("dump/light_field.json"))["has_basis"], false);
}

TEST_F(PackTest, DashIsStandardInputAndOutput) {
  ASSERT_EQ(slf("pack positions.npy -o a.slf").code, 0);
  const Ran piped = slf("pack - -o - <positions.npy");
  EXPECT_EQ(piped.code, 0);
  EXPECT_EQ(piped.out, read("a.slf"));
  const Ran ply = slf("decode - -o - <a.slf");
  EXPECT_EQ(ply.code, 0);
  EXPECT_EQ(ply.out.rfind("ply\n", 0), 0u);
  EXPECT_EQ(slf("info - <a.slf").code, 0);
}

TEST_F(PackTest, StepsAndGroupsAreThoseOfTheFiles) {
  const std::vector<std::int32_t> steps{2, 3, 4, 5, 6, 7}, groups{0, 1};
  write("steps.npy", text_of(npy_file({2, 3}, std::span<const std::int32_t>(steps))));
  write("groups.npy", text_of(npy_file({2}, std::span<const std::int32_t>(groups))));
  ASSERT_EQ(slf("pack positions.npy components.npy -o a.slf --steps steps.npy --groups groups.npy "
                "--levels 2,3 --grid-bits 3")
                .code,
            0);
  const auto info = parsed(slf("info a.slf --json").out);
  EXPECT_EQ(info["step"], nlohmann::json::parse("[[2,3,4],[5,6,7]]"));
  EXPECT_EQ(info["group"], nlohmann::json::parse("[0,1]"));
  EXPECT_EQ(info["bytes_by_type"].contains("index"), true);
  const auto plain = slf("pack positions.npy components.npy -o b.slf --no-index --no-digest");
  ASSERT_EQ(plain.code, 0);
  const auto types = parsed(slf("info b.slf --json").out)["bytes_by_type"];
  EXPECT_FALSE(types.contains("index"));
  EXPECT_FALSE(types.contains("digest"));
}

TEST_F(PackTest, UnitsEndAtTheLastLevelsUnlessToldOtherwise) {
  ASSERT_EQ(slf("pack positions.npy components.npy -o a.slf --grid-bits 5").code, 0);
  ASSERT_EQ(slf("pack positions.npy components.npy -o b.slf --grid-bits 5 --levels 3,4,5").code, 0);
  ASSERT_EQ(slf("pack positions.npy components.npy -o c.slf --grid-bits 5 --levels 5").code, 0);
  EXPECT_EQ(read("a.slf"), read("b.slf"));
  EXPECT_NE(read("a.slf"), read("c.slf"));
}

TEST_F(PackTest, RefusesArraysThatDoNotFitTogether) {
  const std::vector<std::int32_t> twice{1, 1, 1, 1, 1, 1}, outside{0, 0, -1};
  write("twice.npy", text_of(npy_file({2, 3}, std::span<const std::int32_t>(twice))));
  write("outside.npy", text_of(npy_file({1, 3}, std::span<const std::int32_t>(outside))));
  write("bad.npy", "\x93NUMPY");
  write("real.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
        "property float z\nend_header\n0.5 1 2\n");
  expect_failure(slf("pack twice.npy -o a.slf"), 4, "twice.npy", "stands where another does");
  expect_failure(slf("pack outside.npy -o a.slf"), 4, "outside.npy", "grid");
  expect_failure(slf("pack positions.npy -o a.slf --grid-bits 2"), 4, "positions.npy", "grid");
  expect_failure(slf("pack components.npy -o a.slf"), 4, "components.npy", "[points, 3]");
  expect_failure(slf("pack positions.npy positions.npy -o a.slf"), 4, "positions.npy",
                 "components");
  expect_failure(slf("pack bad.npy -o a.slf"), 4, "bad.npy", ".npy");
  expect_failure(slf("pack real.ply -o a.slf"), 4, "real.ply", "whole numbers");
  expect_failure(slf("pack missing.npy -o a.slf"), 3, "missing.npy", "No such file");
  expect_failure(slf("pack positions.npy components.npy -o a.slf --steps positions.npy"), 4,
                 "positions.npy", "steps");
  EXPECT_FALSE(exists("a.slf"));
}

TEST_F(PackTest, WhatIsRefusedIsNamed) {
  const std::vector<std::int32_t> far{0, 0, 1 << 21}, large(24, 1 << 27), groups{0, 2};
  write("far.npy", text_of(npy_file({1, 3}, std::span<const std::int32_t>(far))));
  write("large.npy", text_of(npy_file({4, 2, 3}, std::span<const std::int32_t>(large))));
  write("groups.npy", text_of(npy_file({2}, std::span<const std::int32_t>(groups))));
  const std::string both = "pack positions.npy components.npy -o a.slf ";
  expect_failure(slf("pack far.npy -o a.slf"), 4, "far.npy", "0 to 2^21 - 1");
  expect_failure(slf("pack positions.npy large.npy -o a.slf"), 4, "large.npy: components", "2^27");
  expect_failure(slf(both + "--groups groups.npy"), 4, "groups.npy: groups", "empty");
  expect_failure(slf(both + "--levels 6,8"), 2, "pack: --levels", "the last the grid's bits");
}

TEST_F(PackTest, GeometryAloneHasNoColours) {
  ASSERT_EQ(slf("pack positions.npy -o a.slf").code, 0);
  for (const char* verb :
       {"render a.slf -o x.png", "export a.slf -o x.spz", "export a.slf --mean -o x.ply"})
    expect_failure(slf(verb), 4, "a.slf", "geometry alone, so it has no colours");
}

}  // namespace
}  // namespace slf::cli_pack_test
