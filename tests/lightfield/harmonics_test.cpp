// SPDX-License-Identifier: Apache-2.0
#include "lightfield/harmonics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace slf::harmonics_test {
namespace {

std::array<double, 3> direction(double theta, double gamma) {
  const double r = std::sqrt(1 - gamma * gamma);
  return {r * std::cos(theta), r * std::sin(theta), gamma};
}

TEST(Harmonics, AreOrthonormalInTheMeanOverTheSphere) {
  // Exact quadrature for polynomials of degree 20 in z (Gauss) is replaced by a fine midpoint rule.
  const Harmonics harmonics(kMaxDegree);
  const auto size = static_cast<std::size_t>(harmonics.size());
  ASSERT_EQ(size, 121u);
  constexpr int kTheta = 64, kGamma = 4000;
  std::vector<double> gram(size * size, 0), row(size);
  for (int j = 0; j < kGamma; ++j)
    for (int i = 0; i < kTheta; ++i) {
      harmonics.evaluate(direction(2 * std::numbers::pi * i / kTheta, (2 * j + 1.0) / kGamma - 1),
                         row.data());
      for (std::size_t a = 0; a < size; ++a)
        for (std::size_t b = 0; b <= a; ++b) gram[a * size + b] += row[a] * row[b];
    }
  for (std::size_t a = 0; a < size; ++a)
    for (std::size_t b = 0; b <= a; ++b)
      EXPECT_NEAR(gram[a * size + b] / (kTheta * kGamma), a == b, 1e-4) << a << " " << b;
}

TEST(Harmonics, HaveTheSignsOfGaussianSplattingFiles) {
  const Harmonics harmonics(2);
  const double x = 0.36, y = -0.48, z = 0.8;
  std::vector<double> row(9);
  harmonics.evaluate({x, y, z}, row.data());
  const double four_pi = std::sqrt(4 * std::numbers::pi);
  const double c1 = 0.4886025119029199 * four_pi, c2 = 1.0925484305920792 * four_pi,
               c20 = 0.31539156525252005 * four_pi, c22 = 0.5462742152960396 * four_pi;
  const std::vector<double> expected = {1,
                                        -c1 * y,
                                        c1 * z,
                                        -c1 * x,
                                        c2 * x * y,
                                        -c2 * y * z,
                                        c20 * (2 * z * z - x * x - y * y),
                                        -c2 * x * z,
                                        c22 * (x * x - y * y)};
  for (std::size_t k = 0; k < 9; ++k) EXPECT_NEAR(row[k], expected[k], 1e-12) << k;
}

}  // namespace
}  // namespace slf::harmonics_test
