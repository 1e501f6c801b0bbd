// SPDX-License-Identifier: Apache-2.0
// Where points were: affine motions, lattices between their points and beyond their ends.
#include "geometry/motion.h"

#include <gtest/gtest.h>

#include <random>

namespace slf::motion_test {
namespace {

constexpr int kBits = 7;
constexpr std::int32_t kOne = 1 << Motion::kMatrixBits;

std::vector<std::array<std::int32_t, 3>> some_places(std::int32_t least, std::int32_t most) {
  std::mt19937 random(5);
  std::vector<std::array<std::int32_t, 3>> places;
  for (int i = 0; i < 2000; ++i) {
    auto& place = places.emplace_back();
    for (auto& p : place)
      p = least +
          static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(most - least + 1));
  }
  return places;
}

/// A lattice of the values of `of` at its points.
template <class Of>
Motion lattice_of(int log2, const std::array<std::int32_t, 3>& first,
                  const std::array<std::int32_t, 3>& size, const Of& of) {
  Motion m;
  m.lattice_log2 = log2;
  m.lattice_first = first;
  m.lattice_size = size;
  for (std::int32_t z = 0; z < size[2]; ++z)
    for (std::int32_t y = 0; y < size[1]; ++y)
      for (std::int32_t x = 0; x < size[0]; ++x)
        m.lattice.push_back(of(std::array<std::int32_t, 3>{
            (first[0] + x) << log2, (first[1] + y) << log2, (first[2] + z) << log2}));
  return m;
}

TEST(Spec_8_12_1_Motion, MotionOfNothingIsZero) {
  for (const auto& place : some_places(0, 2 << kBits))
    EXPECT_EQ(Motion().at(place, kBits), Displacement{});
}

TEST(Spec_8_12_1_Motion, AffineIsExactAtIntegers) {
  Motion m;
  m.matrix = {{{kOne, -2 * kOne + 1, 0}, {kOne / 2, 0, kOne}, {0, kOne / 4, -kOne}}};
  m.matrix[0][1] = -kOne;
  m.shift = {33, -700, 5};
  for (const auto& p : some_places(0, 2 << kBits)) {
    // Halves of a voxel from the centre: 8 sixteenths each.
    const std::int32_t x = p[0] - (1 << kBits), y = p[1] - (1 << kBits), z = p[2] - (1 << kBits);
    EXPECT_EQ(m.at(p, kBits),
              (Displacement{33 + 8 * x - 8 * y, -700 + 4 * x + 8 * z, 5 + 2 * y - 8 * z}));
  }
}

TEST(Spec_8_12_1_Motion, AffineRoundsToTheNearest) {
  Motion m;
  m.matrix[0][0] = kOne / 16;  // of eight sixteenths a half
  EXPECT_EQ(m.at({(1 << kBits) + 1, 0, 0}, kBits)[0], 1);
  EXPECT_EQ(m.at({(1 << kBits) - 1, 0, 0}, kBits)[0], 0);
  EXPECT_EQ(m.at({(1 << kBits) - 3, 0, 0}, kBits)[0], -1);
}

TEST(Spec_8_12_1_Motion, LatticeOfALinearFieldIsTheAffineWithinItsEnds) {
  const auto linear = [](const std::array<std::int32_t, 3>& voxel) {
    return Displacement{16 * voxel[0] - 32 * voxel[1] + 48, 16 * voxel[2], -16 * voxel[0] - 64};
  };
  for (const int log2 : {3, 4, 5}) {
    const std::int32_t steps = 128 >> log2;
    const Motion m = lattice_of(log2, {0, 0, 0}, {steps + 1, steps + 1, steps + 1}, linear);
    for (const auto& p : some_places(0, 256))
      EXPECT_EQ(m.at(p, kBits),
                (Displacement{8 * p[0] - 16 * p[1] + 48, 8 * p[2], -8 * p[0] - 64}));
  }
}

TEST(Spec_8_12_1_Motion, LatticeIsThatOfItsEndsBeyondThem) {
  std::mt19937 random(1);
  const auto chance = [&](const auto&) {
    Displacement d;
    for (auto& part : d) part = static_cast<std::int32_t>(random() % 4001) - 2000;
    return d;
  };
  const Motion m = lattice_of(3, {4, 5, 6}, {4, 3, 2}, chance);
  for (const auto& p : some_places(-100, 400)) {
    auto within = p;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t first = m.lattice_first[i] << 4;
      within[i] = std::clamp(p[i], first, first + ((m.lattice_size[i] - 1) << 4));
    }
    EXPECT_EQ(m.at(p, kBits), m.at(within, kBits));
  }
}

TEST(Spec_8_12_1_Motion, LatticeOfOnePointIsThatPointEverywhere) {
  Motion m = lattice_of(8, {0, 3, 1}, {1, 1, 1}, [](const auto&) {
    return Displacement{4, -8, 12};
  });
  m.shift = {1, 1, 1};
  for (const auto& p : some_places(-50, 300)) EXPECT_EQ(m.at(p, kBits), (Displacement{5, -7, 13}));
}

TEST(Spec_8_12_1_Motion, GreatestIsClampedWithoutOverflow) {
  const std::int32_t v = 4 << 16, first = (1 << 18) - 1;
  Motion m = lattice_of(8, {first, first, first}, {64, 64, 64}, [&](const auto&) {
    return Displacement{v, v, -v};
  });
  for (auto& row : m.matrix) row.fill(Motion::kMostEntry);
  m.matrix[2].fill(-Motion::kMostEntry);
  m.shift = {Motion::kMostShift, Motion::kMostShift, -Motion::kMostShift};
  const std::int32_t far = (2 << 21) - 1;
  EXPECT_EQ(m.at({far, far, far}, 21), (Displacement{(1 << 24) - 16, (1 << 24) - 16, -(1 << 24)}));
  EXPECT_EQ(m.at({1, 1, 1}, 21), (Displacement{-(1 << 24), -(1 << 24), (1 << 24) - 16}));
}

}  // namespace
}  // namespace slf::motion_test
