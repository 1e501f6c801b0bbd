// SPDX-License-Identifier: Apache-2.0
// What a level promises: the encoder gives the lowest, the decoder holds a stream to it. Spec 9.
#include "bitstream/level.h"

#include "conformance/edit_units.h"
#include "frames_support.h"
#include "slf/decoder.h"

namespace slf::level_test {
namespace {

using namespace test;
using conformance::EditableUnit;

int level_of(const Bytes& stream) {
  const auto info = read_info(stream);
  EXPECT_TRUE(info);
  return info ? info->level : -1;
}

Bytes packed(const LightField& field) {
  const auto stream = pack(field, {});
  EXPECT_TRUE(stream);
  return stream ? *stream : Bytes{};
}

Bytes with_filler(std::uint32_t level, std::size_t bytes) {
  return conformance::edited(conformance::base_stream(false), [&](auto& units) {
    conformance::edit_sequence(units, [&](auto& set) { set.sps_level = level; });
    units.insert(units.begin() + 1, EditableUnit{UnitType::kFiller, Bytes(bytes, 0)});
  });
}

TEST(Spec_9_Levels, AdmitRowsAndValuesUpToTheLimit) {
  for (std::size_t level = 1; level < kLevels.size(); ++level) {
    const LevelLimits& most = kLevels[level];
    EXPECT_TRUE(most.admits(most.rows, 0));
    EXPECT_FALSE(most.admits(most.rows + 1, 0));
    EXPECT_TRUE(most.admits(most.values / 192, 64));
    EXPECT_FALSE(most.admits(most.values / 192 + 1, 64));
  }
  EXPECT_TRUE(kLevels[0].admits(std::uint64_t{1} << 38, 4096));
}

TEST(Spec_9_Levels, TheEncoderGivesTheLowestThatAdmitsTheStream) {
  EXPECT_EQ(level_of(packed(make_field(sphere_cloud(5), 5, 2))), 1);
  std::vector<Voxel> box;  // 2^20 + 2^14 points: more than level 1 admits
  for (std::int32_t z = 0; z < 65; ++z)
    for (std::int32_t y = 0; y < 128; ++y)
      for (std::int32_t x = 0; x < 128; ++x) box.push_back({x, y, z});
  EXPECT_EQ(level_of(packed(make_field(sorted_distinct(box), 7, 0))), 2);
}

TEST(Spec_9_Levels, AUnitOfMoreBytesThanItsLevelAdmitsIsRefused) {
  const std::size_t most = std::size_t{1} << 24;
  EXPECT_TRUE(decode(with_filler(1, most)));
  EXPECT_TRUE(decode(with_filler(0, most + 1)));
  const auto refused = decode(with_filler(1, most + 1));
  ASSERT_FALSE(refused);
  EXPECT_STREQ(refused.error().element, "unit_length");
}

TEST(Spec_9_Levels, FramesFasterThanTheirLevelAreCodedWithoutOne) {
  const auto fields = fields_of(Moves::kShift, 3);
  FrameEncoder encoder(frame_parameters(8));
  std::vector<Bytes> frames;
  for (const double time : {0.0, 1.0, 1.0 + 1e-6})
    frames.push_back(*encoder.add(fields[frames.size()], time));
  EXPECT_EQ(level_of(frames[0]), 1);
  ASSERT_TRUE(begins_intra(frames[2]));
  EXPECT_EQ(level_of(frames[2]), 0);
  const Bytes stream = joined(frames);
  FrameDecoder decoder = opened(stream);
  EXPECT_EQ(decoded_frame(decoder, 2).positions, fields[2].positions);
}

}  // namespace
}  // namespace slf::level_test
