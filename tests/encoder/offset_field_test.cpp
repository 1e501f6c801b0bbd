// SPDX-License-Identifier: Apache-2.0
#include "encoder/refine/offset_field.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "sphere_points.h"

namespace slf::offset_field_test {
namespace {

class OffsetFieldTest : public testing::Test {
 protected:
  static constexpr OffsetRange kRange{-0.04, 0.01, 9};
  const SurfacePoints points_ = sphere(2000);
  const SurfaceNeighbours near_ = find_neighbours(points_, 12, 0.1, 2);

  std::vector<float> costs_at(std::size_t label) const {
    std::vector<float> costs(points_.size() * kRange.count);
    for (std::size_t i = 0; i < costs.size(); ++i) {
      const double apart = double(i % kRange.count) - double(label);
      costs[i] = float(std::min(0.1 * apart * apart, 1.0));
    }
    return costs;
  }
};

TEST_F(OffsetFieldTest, TheCheapestOffsetIsTaken) {
  for (const float offset : choose_offsets(costs_at(6), kRange, near_, {}))
    EXPECT_NEAR(offset, 0.02, 1e-3);
}

TEST_F(OffsetFieldTest, NothingMovesWhereAllOffsetsCostTheSame) {
  const std::vector<float> flat(points_.size() * kRange.count, 0.7f);
  for (const float offset : choose_offsets(flat, kRange, near_, {})) EXPECT_NEAR(offset, 0, 1e-6);
}

TEST_F(OffsetFieldTest, APointThatDisagreesFollowsItsNeighbours) {
  std::vector<float> costs = costs_at(6);
  for (std::size_t l = 0; l < kRange.count; ++l) costs[100 * kRange.count + l] = l == 0 ? 0 : 1;
  EXPECT_NEAR(choose_offsets(costs, kRange, near_, {})[100], 0.02, 0.01);
}

}  // namespace
}  // namespace slf::offset_field_test
