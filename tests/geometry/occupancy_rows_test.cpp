// SPDX-License-Identifier: Apache-2.0
// Rows of the octree's contexts. Spec 8.4.7.
#include "geometry/occupancy_rows.h"

#include <gtest/gtest.h>

#include <vector>

namespace slf::occupancy_rows_test {
namespace {

SelectedRows select(std::vector<EightLanes>& table, std::initializer_list<std::size_t> slow,
                    std::initializer_list<std::size_t> fast) {
  static SelectedRows::List list;
  SelectedRows rows(table.data(), list);
  for (const std::size_t row : slow) rows.add(row);
  rows.end_slow();
  for (const std::size_t row : fast) rows.add(row);
  return rows;
}

TEST(Spec_8_4_7_Rows, SayWhatNodesWithTheSameRowsWere) {
  std::vector<EightLanes> table(8);
  for (int i = 0; i < 300; ++i) {
    select(table, {0}, {1}).update(0xFF, 0x0F, 4);
    select(table, {0}, {2}).update(0xFF, 0xF0, 4);
  }
  const auto first = select(table, {0}, {1}).logistic(),
             second = select(table, {0}, {2}).logistic();
  for (std::size_t c = 0; c < 8; ++c) {
    EXPECT_GT(c < 4 ? first[c] : second[c], 512) << c;
    EXPECT_LT(c < 4 ? second[c] : first[c], -512) << c;
  }
}

TEST(Spec_8_4_7_Rows, FastOnesMoveFourTimesAsFarAndThoseSelectedTwiceTwice) {
  std::vector<EightLanes> table(8);
  select(table, {0, 3, 3}, {1}).update(0xFF, 0x01, 8);
  // e = (65536 - 32768) >> 1, f = 32 * 8.
  EXPECT_EQ(table[0].values()[0], 64);
  EXPECT_EQ(table[3].values()[0], 128);
  EXPECT_EQ(table[1].values()[0], 256);
  EXPECT_EQ(table[0].values()[1], -64);
  EXPECT_EQ(table[2].values()[0], 0);
}

TEST(Spec_8_4_7_Rows, LanesOfDecisionsThatWereNotMadeStay) {
  std::vector<EightLanes> table(4);
  select(table, {0}, {1}).update(0b00000101, 0b00000001, 8);
  for (std::size_t i = 0; i < 8; ++i) {
    EXPECT_EQ(table[1].values()[i] > 0, i == 0) << i;
    EXPECT_EQ(table[1].values()[i] < 0, i == 2) << i;
  }
}

TEST(Spec_8_4_7_Rows, AddUpWithSaturationInTheirOrder) {
  std::vector<EightLanes> table = {EightLanes(30000), EightLanes(30000), EightLanes(-20000)};
  EXPECT_EQ(select(table, {0, 1}, {2}).logistic()[0], (32767 - 20000) >> 4);
  EXPECT_EQ(select(table, {0, 2}, {1}).logistic()[0], 32767 >> 4);
}

}  // namespace
}  // namespace slf::occupancy_rows_test
