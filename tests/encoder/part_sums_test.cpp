// SPDX-License-Identifier: Apache-2.0
// The unit that parts of a scene have for being merged.
#include "encoder/parts/part_sums.h"

#include <gtest/gtest.h>

#include <random>

namespace slf::part_sums_test {
namespace {

constexpr std::size_t kPlanes = 6;

SliceTable table() {
  SliceTable of_three;
  of_three.slices_num_minus1 = 2;
  of_three.slices = {{1, 100}, {0, 50}, {3, 400}};
  return of_three;
}

PartSums part() {
  PartSums sums;
  for (std::size_t i = 0; i < sums.plan.size(); ++i)
    sums.plan[i] = static_cast<std::uint8_t>(7 * i);
  sums.rdo = 0.25;
  std::mt19937 random(1);
  for (const std::size_t slice : {std::size_t{0}, std::size_t{2}}) {
    SliceSums one{slice, {}, {}};
    if (slice == 2) one.digest.assign(32, 0xAB);
    for (std::size_t i = 0; i < table().slices[slice].cells() * kPlanes; ++i)
      one.sums.push_back(static_cast<std::int32_t>(random() % 200001) - 100000);
    sums.slices.push_back(one);
  }
  return sums;
}

TEST(PartSums, AreReadAsTheyWereWritten) {
  const PartSums written = part();
  const auto read = parse_part_sums(write_part_sums(written), table(), kPlanes);
  ASSERT_TRUE(read) << to_string(read.error());
  EXPECT_EQ(read->plan, written.plan);
  EXPECT_EQ(read->rdo, written.rdo);
  ASSERT_EQ(read->slices.size(), 2u);
  for (std::size_t s = 0; s < 2; ++s) {
    EXPECT_EQ(read->slices[s].slice, written.slices[s].slice);
    EXPECT_EQ(read->slices[s].digest, written.slices[s].digest);
    EXPECT_EQ(read->slices[s].sums, written.slices[s].sums);
  }
}

TEST(PartSums, EveryTruncationIsAnErrorThatNamesAnElement) {
  const auto bytes = write_part_sums(part());
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const auto read = parse_part_sums(std::span(bytes).first(size), table(), kPlanes);
    ASSERT_FALSE(read) << size;
    EXPECT_EQ(std::string(read.error().element).rfind("part_", 0), 0u) << size;
  }
}

TEST(PartSums, WhatSlicesAreNotAskedForIsRefused) {
  const auto element = [](const PartSums& sums, std::size_t planes) {
    const auto read = parse_part_sums(write_part_sums(sums), table(), planes);
    return std::string(read ? "" : read.error().element);
  };
  PartSums wrong = part();
  wrong.rdo = 2;
  EXPECT_EQ(element(wrong, kPlanes), "part_rdo");
  wrong = part();
  wrong.slices[1].slice = 3;
  EXPECT_EQ(element(wrong, kPlanes), "part_slice_id");
  wrong = part();
  wrong.slices[1].slice = 0;
  EXPECT_EQ(element(wrong, kPlanes), "part_slice_id");
  EXPECT_NE(element(part(), kPlanes + 1), "");
  EXPECT_EQ(element(part(), std::size_t{1} << 40), "part_sum");  // nothing is allocated for it
}

TEST(PartSums, NoDamageIsWorseThanAnError) {
  const auto bytes = write_part_sums(part());
  std::mt19937 random(2);
  for (int i = 0; i < 3000; ++i) {
    auto damaged = bytes;
    damaged[random() % damaged.size()] ^= static_cast<std::uint8_t>(1 + random() % 255);
    const auto read = parse_part_sums(damaged, table(), kPlanes);
    if (!read) {
      EXPECT_NE(*read.error().element, 0);
    }
  }
}

}  // namespace
}  // namespace slf::part_sums_test
