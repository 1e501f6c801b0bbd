// SPDX-License-Identifier: Apache-2.0
// Draco geometry (spec 8.5): what stands in front of Draco.
#include <gtest/gtest.h>

#include "geometry/draco_decoder.h"
#include "geometry/encoder/draco_encoder.h"
#include "geometry/morton.h"

namespace slf::draco_test {
namespace {

constexpr int kBits = 4;

std::vector<std::uint8_t> payload_of(const std::vector<Voxel>& voxels) {
  return encode_draco(voxels).value_or(std::vector<std::uint8_t>{});
}

class Draco : public testing::Test {
 protected:
  void SetUp() override {
    payload_ = payload_of({{1, 2, 3}, {4, 5, 6}, {15, 0, 15}});
    if (payload_.empty()) GTEST_SKIP() << "built without Draco";
  }
  void expect_refused(std::size_t max_points = 3) const {
    const auto decoded = decode_draco(payload_, kBits, max_points);
    ASSERT_FALSE(decoded);
    EXPECT_EQ(decoded.error().code, Errc::kOutOfRange);
    EXPECT_STREQ(decoded.error().element, "gu_draco");
  }
  std::vector<std::uint8_t> payload_;
};

TEST_F(Draco, PositionsComeBack) {
  const auto decoded = decode_draco(payload_, kBits, 3);
  ASSERT_TRUE(decoded);
  const std::vector<std::uint64_t> codes = {morton({1, 2, 3}), morton({4, 5, 6}),
                                            morton({15, 0, 15})};
  EXPECT_EQ(*decoded, codes);
}

TEST_F(Draco, APositionTwiceIsRefused) {
  payload_ = payload_of({{1, 2, 3}, {1, 2, 3}, {4, 5, 6}});
  expect_refused();
}

// By the number, type and length of attributes 70 bytes could ask for gigabytes.
TEST_F(Draco, NothingButPositionsReachesTheLibrary) {
  const auto sound = payload_;
  for (const std::size_t at : {0u, 5u, 7u, 8u, 9u, 10u, 15u, 16u, 17u, 18u, 19u, 20u})
    for (const int value : {2, 9, 127, 255}) {
      payload_ = sound;
      if (payload_[at] == value) continue;
      payload_[at] = static_cast<std::uint8_t>(value);
      SCOPED_TRACE(std::to_string(at) + " = " + std::to_string(value));
      expect_refused();
    }
}

TEST_F(Draco, MorePointsThanTheSliceHasAreRefused) {
  expect_refused(2);
  payload_[13] = 1;  // 65,536 more
  expect_refused();
}

TEST_F(Draco, ACutHeaderIsRefused) {
  const auto sound = payload_;
  for (std::size_t size = 0; size < 22; ++size) {
    payload_.assign(sound.begin(), sound.begin() + static_cast<std::ptrdiff_t>(size));
    SCOPED_TRACE(size);
    expect_refused();
  }
}

}  // namespace
}  // namespace slf::draco_test
