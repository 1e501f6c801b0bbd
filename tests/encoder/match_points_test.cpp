// SPDX-License-Identifier: Apache-2.0
// Points of one frame are found in the next by where they are and what they look like.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "encoder/match_points.h"
#include "geometry/morton.h"

namespace slf::match_points_test {
namespace {

constexpr int kBits = 8;

struct Cloud {
  std::vector<std::uint64_t> codes;
  std::vector<std::int32_t> values;

  PointValues view() const { return {codes, values}; }
};

/// Points that differ, each moved by up to `by` along every axis, without those that `left_out`
/// says.
Cloud cloud_of(int by, bool (*left_out)(int)) {
  std::mt19937 random(7);
  std::map<std::uint64_t, std::array<std::int32_t, 2>> points;
  for (int p = 0; p < 300; ++p) {
    Voxel v;
    for (auto& x : v) x = 20 + static_cast<std::int32_t>(random() % 200);
    const auto move = static_cast<std::int32_t>(random() % 64);
    const std::array<std::int32_t, 2> values{static_cast<std::int32_t>(random() % 5000), p};
    for (std::size_t k = 0; k < 3; ++k) v[k] += by == 0 ? 0 : (move >> 2 * k) % (2 * by + 1) - by;
    if (!left_out(p)) points[morton(v)] = values;
  }
  Cloud cloud;
  for (const auto& [code, values] : points) {
    cloud.codes.push_back(code);
    cloud.values.insert(cloud.values.end(), values.begin(), values.end());
  }
  return cloud;
}

TEST(MatchPoints, FindsEachAgainAmongOthers) {
  const Cloud before = cloud_of(0, [](int p) { return p % 7 == 0; }),
              now = cloud_of(1, [](int p) { return p % 11 == 0; });
  const std::vector<std::uint32_t> steps{10, 1000000};
  const auto moves = match_points(now.view(), before.view(), steps, {}, kBits, 1);
  ASSERT_EQ(moves.size(), before.codes.size());
  std::size_t right = 0, there = 0;
  for (std::size_t p = 0; p < moves.size(); ++p) {
    const auto id = before.values[2 * p + 1];
    if (id % 11 == 0) continue;
    ++there;
    Voxel v = from_morton(before.codes[p]);
    for (std::size_t k = 0; k < 3; ++k) v[k] += moves[p][k];
    const auto at = std::find(now.codes.begin(), now.codes.end(), morton(v));
    right += at != now.codes.end() && now.values[2 * std::size_t(at - now.codes.begin()) + 1] == id;
  }
  EXPECT_GT(right, there * 95 / 100);
}

TEST(MatchPoints, IsOneToOneAndTheSameForAnyThreads) {
  const Cloud before = cloud_of(0, [](int p) { return p % 2 == 0; }),
              now = cloud_of(1, [](int) { return false; });
  const std::vector<std::uint32_t> steps{10, 10};
  const auto moves = match_points(now.view(), before.view(), steps, {}, kBits, 1);
  EXPECT_EQ(moves, match_points(now.view(), before.view(), steps, {}, kBits, 3));
  const MovedPoints moved = move_points(before.codes, moves, {}, kBits);
  EXPECT_EQ(std::adjacent_find(moved.codes.begin(), moved.codes.end()), moved.codes.end());
  EXPECT_TRUE(
      std::includes(now.codes.begin(), now.codes.end(), moved.codes.begin(), moved.codes.end()));
}

}  // namespace
}  // namespace slf::match_points_test
