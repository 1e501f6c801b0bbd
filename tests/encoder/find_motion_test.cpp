// SPDX-License-Identifier: Apache-2.0
// Motions that the encoder finds: of things that shift, turn and bend, from nothing and from the
// motion of the frame before.
#include "encoder/find_motion.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/morton.h"

namespace slf::find_motion_test {
namespace {

constexpr int kBits = 7;
constexpr double kCentre = 64;
using Place = std::array<double, 3>;

/// Points of a surface and their colours, as a frame has them.
struct Frame {
  std::vector<std::uint64_t> codes;
  std::vector<std::array<float, 3>> colours;
  FramePoints points() const { return {codes, colours}; }
};

/// Where a place of a frame was in the frame before.
using Before = Place (*)(const Place&);

Place stays(const Place& p) { return p; }
Place shifts(const Place& p) { return {p[0] - 4, p[1] + 3, p[2] - 2}; }
Place turns(const Place& p) {
  const double c = std::cos(0.1), s = std::sin(0.1), x = p[0] - kCentre, y = p[1] - kCentre;
  return {kCentre + c * x + s * y, kCentre - s * x + c * y, p[2]};
}
Place bends(const Place& p) { return {p[0] + 4 * std::sin(p[2] / 12), p[1], p[2]}; }

float colour_at(const Place& p) {
  return static_cast<float>(128 + 50 * std::sin(p[0] / 5) + 40 * std::sin(p[1] / 7 + p[2] / 4));
}

/// An ellipsoid that has moved `times` times; its colours move with it.
Frame ellipsoid(Before before, int times) {
  std::map<std::uint64_t, float> voxels;
  for (std::int32_t z = 0; z < 1 << kBits; ++z)
    for (std::int32_t y = 0; y < 1 << kBits; ++y)
      for (std::int32_t x = 0; x < 1 << kBits; ++x) {
        Place p = {x + 0.5, y + 0.5, z + 0.5};
        for (int i = 0; i < times; ++i) p = before(p);
        const double a = (p[0] - kCentre) / 30, b = (p[1] - kCentre) / 22,
                     c = (p[2] - kCentre) / 36;
        if (std::abs(a * a + b * b + c * c - 1) < 0.035) voxels[morton({x, y, z})] = colour_at(p);
      }
  Frame frame;
  for (const auto& [code, colour] : voxels) {
    frame.codes.push_back(code);
    frame.colours.push_back({colour, colour, colour});
  }
  return frame;
}

/// Voxels by which a motion misses where the points of a frame came from: mean over the points.
double mean_miss(const Motion& motion, const Frame& frame, Before before) {
  double sum = 0;
  for (const std::uint64_t code : frame.codes) {
    const Voxel v = from_morton(code);
    const Place p = {v[0] + 0.5, v[1] + 0.5, v[2] + 0.5}, truth = before(p);
    const Displacement d = motion.at({2 * v[0] + 1, 2 * v[1] + 1, 2 * v[2] + 1}, kBits);
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i) square += std::pow(p[i] + d[i] / 16.0 - truth[i], 2);
    sum += std::sqrt(square);
  }
  return sum / static_cast<double>(frame.codes.size());
}

Motion found(Before before, int times, const Motion& previous) {
  return choose_motion(ellipsoid(before, times).points(), ellipsoid(before, times - 1).points(),
                       kBits, previous);
}

TEST(FindMotion, WhatStandsStillHasNone) { EXPECT_TRUE(found(stays, 1, {}).is_zero()); }

TEST(FindMotion, RigidOnesAreFoundBelowAVoxelAndTakeNoLattice) {
  for (const Before before : {shifts, turns}) {
    const Motion motion = found(before, 1, {});
    EXPECT_EQ(motion.lattice_log2, 0);
    EXPECT_LT(mean_miss(motion, ellipsoid(before, 1), before), 0.3);
  }
}

TEST(FindMotion, WhatBendsTakesALattice) {
  const Motion motion = found(bends, 1, {});
  EXPECT_GT(motion.lattice_log2, 0);
  EXPECT_LT(mean_miss(motion, ellipsoid(bends, 1), bends), 0.7);
}

TEST(FindMotion, GoesOnFromThatOfTheFrameBefore) {
  for (const Before before : {shifts, turns, bends}) {
    const Motion first = found(before, 1, {}), second = found(before, 2, first);
    EXPECT_EQ(second.lattice_log2 > 0, before == bends);
    EXPECT_LT(mean_miss(second, ellipsoid(before, 2), before), before == bends ? 0.7 : 0.3);
  }
}

TEST(FindMotion, BeginsToBendWhereTheFrameBeforeDidNot) {
  Motion shift;
  shift.shift = {8, 0, 0};
  const Motion motion = found(bends, 1, shift);
  EXPECT_GT(motion.lattice_log2, 0);
  EXPECT_LT(mean_miss(motion, ellipsoid(bends, 1), bends), 0.7);
}

TEST(FindMotion, IsNotMisledByTheFrameBefore) {
  Motion away;
  away.shift = {-16 * 40, 16 * 30, 0};  // beyond everything
  EXPECT_EQ(found(turns, 1, away), found(turns, 1, {}));
}

TEST(FindMotion, FramesWithoutPointsHaveNone) {
  const Frame some = ellipsoid(stays, 0), none;
  EXPECT_TRUE(choose_motion(some.points(), none.points(), kBits, {}).is_zero());
  EXPECT_TRUE(choose_motion(none.points(), some.points(), kBits, {}).is_zero());
}

TEST(FindMotion, OnePointAndTheSmallestGridAreTaken) {
  Frame one;
  one.codes = {0};
  one.colours = {{9, 9, 9}};
  for (const int bits : {1, 4, 21})
    EXPECT_TRUE(choose_motion(one.points(), one.points(), bits, {}).is_zero());
}

}  // namespace
}  // namespace slf::find_motion_test
