// SPDX-License-Identifier: Apache-2.0
// Normals as two coordinates on an octahedron.
#include "lightfield/octahedral.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slf::octahedral_test {
namespace {

TEST(OctahedralTest, LevelsOfEveryBitDepthGiveUnitVectorsThatQuantiseBackToThemselves) {
  for (const int bits : {4, 8, 12}) {
    const int levels = 1 << bits, stride = bits == 12 ? 61 : 1;
    for (int a = 0; a < levels; a += stride)
      for (int b = 0; b < levels; b += stride) {
        const std::array<std::uint16_t, 2> q{std::uint16_t(a), std::uint16_t(b)};
        const auto v = dequantise_normal(q, bits);
        ASSERT_NEAR(v[0] * v[0] + v[1] * v[1] + v[2] * v[2], 1, 1e-12);
        const auto back = dequantise_normal(quantise_normal(v, bits), bits);
        // On the border of the square two levels stand for one vector, so vectors are compared.
        for (std::size_t k = 0; k < 3; ++k) ASSERT_NEAR(back[k], v[k], 1e-9) << a << ' ' << b;
      }
  }
}

TEST(OctahedralTest, HandComputedValues) {
  const auto up =
      quantise_normal({0, 0, 1}, 8);  // the middle of the square lies between two levels
  EXPECT_EQ(up, (std::array<std::uint16_t, 2>{128, 128}));
  EXPECT_EQ(quantise_normal({1, 0, 0}, 8)[0], 255);
  EXPECT_EQ(quantise_normal({0, -1, 0}, 8)[1], 0);
  const auto folded = octahedral_from_vector({1, 1, -2});  // x + y + |z| = 4: (1/4, 1/4) -> 3/4
  EXPECT_DOUBLE_EQ(folded[0], 0.75);
  EXPECT_DOUBLE_EQ(folded[1], 0.75);
}

}  // namespace
}  // namespace slf::octahedral_test
