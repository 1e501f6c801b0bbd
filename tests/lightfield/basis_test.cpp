// SPDX-License-Identifier: Apache-2.0
// The basis against hand-computed values, its Gram matrix, and its form as plain B-splines.
#include "lightfield/basis.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "lightfield/basis_table.h"
#include "slf/view_map.h"

namespace slf::basis_test {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(CardinalBspline, HasTheTextbookValuesAtIntegersAndHalves) {
  EXPECT_EQ(cardinal_bspline(1, 0.0), 1);
  EXPECT_EQ(cardinal_bspline(1, 1.0), 0);
  EXPECT_DOUBLE_EQ(cardinal_bspline(2, 0.25), 0.25);
  EXPECT_DOUBLE_EQ(cardinal_bspline(2, 1.75), 0.25);
  EXPECT_DOUBLE_EQ(cardinal_bspline(3, 1.5), 0.75);
  EXPECT_DOUBLE_EQ(cardinal_bspline(4, 1.0), 1.0 / 6);
  EXPECT_DOUBLE_EQ(cardinal_bspline(4, 2.0), 4.0 / 6);
  EXPECT_EQ(cardinal_bspline(4, 4.0), 0);
}

TEST(WaveletTaps, AreHaarForOrderOneAndChuiWangForOrderTwo) {
  const auto haar = wavelet_taps(1);
  EXPECT_DOUBLE_EQ(haar[0], 1);
  EXPECT_DOUBLE_EQ(haar[1], -1);
  const auto linear = wavelet_taps(2);
  const std::array<double, 5> expected{1, -6, 10, -6, 1};
  for (std::size_t n = 0; n < 5; ++n) EXPECT_NEAR(linear[n], expected[n] / 12, 1e-15) << n;
  EXPECT_EQ(linear[5], 0);
  // Order 3, Chui and Wang 1992: 1/480 [1, -29, 147, -303, 303, -147, 29, -1].
  const std::array<double, 8> quadratic{1, -29, 147, -303, 303, -147, 29, -1};
  for (std::size_t n = 0; n < 8; ++n)
    EXPECT_NEAR(wavelet_taps(3)[n], quadratic[n] / 480, 1e-15) << n;
}

TEST(WaveletValue, OrderOneIsTheHaarFunctionOfItsScaleAndOffset) {
  EXPECT_EQ(wavelet_value(1, 0, 0.3), 1);
  EXPECT_EQ(wavelet_value(1, 1, 0.49), 1);
  EXPECT_EQ(wavelet_value(1, 1, 0.5), -1);
  EXPECT_EQ(wavelet_value(1, 6, 0.5), 1);  // scale 2, offset 2: support [0.5, 0.75)
  EXPECT_EQ(wavelet_value(1, 6, 0.63), -1);
  EXPECT_EQ(wavelet_value(1, 6, 0.76), 0);
  EXPECT_EQ(wavelet_value(1, 6, 0.49), 0);
}

TEST(WaveletValue, OrderTwoHasItsTapsAtTheNodesAndWrapsAround) {
  // Scale 2, offset 0: psi(4x), N_2(8x - n) peaks at 8x = n + 1.
  EXPECT_NEAR(wavelet_value(2, 4, 1.0 / 8), 1.0 / 12, 1e-15);
  EXPECT_NEAR(wavelet_value(2, 4, 3.0 / 8), 10.0 / 12, 1e-15);
  EXPECT_NEAR(wavelet_value(2, 4, 2.5 / 8), 2.0 / 12, 1e-15);
  EXPECT_NEAR(wavelet_value(2, 4, 7.0 / 8), 0, 1e-15);
  // Scale 2, offset 3: 8x = 7 .. 11, so the peak is at 9/8, seen at 1/8.
  EXPECT_NEAR(wavelet_value(2, 7, 1.0 / 8), 10.0 / 12, 1e-15);
  // Scale 0: everything folds on two nodes, -(6 + 6) / 12 and (1 + 10 + 1) / 12.
  EXPECT_NEAR(wavelet_value(2, 1, 0.5), 1, 1e-15);
  EXPECT_NEAR(wavelet_value(2, 1, 0.0), -1, 1e-15);
}

TEST(DirectionOf, IsAzimuthAndSineOfElevation) {
  const auto up_right = direction_of({0, 2, 2});
  EXPECT_FLOAT_EQ(up_right[0], static_cast<float>(kPi / 2));
  EXPECT_FLOAT_EQ(up_right[1], static_cast<float>(std::sqrt(0.5)));
  const auto back = direction_of({-3, 0, -4});
  EXPECT_FLOAT_EQ(back[0], static_cast<float>(kPi));
  EXPECT_FLOAT_EQ(back[1], -0.8f);
  EXPECT_EQ(direction_of({0, 0, 5})[1], 1.0f);
}

TEST(BasisValue, IsTheProductOfTheAxesWithThetaFastest) {
  const Basis basis;  // o = 2, 16 x 8
  EXPECT_EQ(basis_value(basis, 0, 1.0, 0.5), 1);
  const int k = 4 * 16 + 8;                                    // i1 = 4 (scale 2), i0 = 8 (scale 3)
  const double theta = 2 * kPi * 3 / 16, gamma = 2 * 3.0 / 8;  // the peaks of both
  EXPECT_NEAR(basis_value(basis, k, theta, gamma), 100.0 / 144, 1e-14);
  EXPECT_NEAR(basis_value(basis, k, theta - 2 * kPi, gamma), 100.0 / 144, 1e-14);
  EXPECT_NEAR(basis_value(basis, k, theta, gamma - 2), 100.0 / 144, 1e-14);
}

TEST(BasisValue, IsTheSameAtBothPolesBecauseGammaIsPeriodic) {
  const Basis basis;
  for (int k = 0; k < basis.num_functions(); ++k)
    EXPECT_NEAR(basis_value(basis, k, 0.7, -1), basis_value(basis, k, 0.7, 1), 1e-12);
}

class AxisTest : public testing::TestWithParam<int> {};  // the order

TEST_P(AxisTest, TheSplineFormIsTheDefinition) {
  const int order = GetParam();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int scales = 0; scales <= 6; ++scales) {
    const AxisTable table(order, scales);
    std::vector<double> row(static_cast<std::size_t>(table.size()));
    for (int n = 0; n < 50; ++n) {
      const double x = n == 0 ? 0 : uniform(random);
      table.evaluate(x, row.data());
      for (int i = 0; i < table.size(); ++i)
        ASSERT_NEAR(row[static_cast<std::size_t>(i)], wavelet_value(order, i, x), 1e-12)
            << "scales " << scales << ", function " << i << ", x " << x;
    }
  }
}

TEST_P(AxisTest, EveryFunctionButTheConstantHasZeroMean) {
  const AxisTable table(GetParam(), 5);
  EXPECT_NEAR(table.inner_product(0, 0), 1, 1e-14);
  for (int i = 1; i < table.size(); ++i) EXPECT_NEAR(table.inner_product(0, i), 0, 1e-14) << i;
}

TEST_P(AxisTest, ScalesAreOrthogonalToEachOther) {
  const AxisTable table(GetParam(), 4);
  for (int i = 0; i < table.size(); ++i)
    for (int j = 0; j < table.size(); ++j)
      if (i != 0 && j != 0 && wavelet_scale(i) != wavelet_scale(j)) {
        const double norms = table.inner_product(i, i) * table.inner_product(j, j);
        EXPECT_LT(std::abs(table.inner_product(i, j)), 1e-5 * std::sqrt(norms)) << i << ", " << j;
      }
}

TEST_P(AxisTest, InnerProductsAreTheIntegralsOfTheDefinition) {
  const int order = GetParam();
  const AxisTable table(order, 3);
  constexpr int kSamples = 4096;  // midpoint rule: error of a spline's integral ~ 1 / samples^2
  for (const auto& [i, j] : {std::pair{1, 1}, {2, 3}, {5, 5}, {4, 5}, {4, 7}}) {
    double sum = 0;
    for (int n = 0; n < kSamples; ++n) {
      const double x = (n + 0.5) / kSamples;
      sum += wavelet_value(order, i, x) * wavelet_value(order, j, x);
    }
    EXPECT_NEAR(table.inner_product(i, j), sum / kSamples, 2e-6) << i << ", " << j;
  }
}

INSTANTIATE_TEST_SUITE_P(Order, AxisTest, testing::Range(1, 5));

double largest_correlation_within_a_scale(int order) {
  const AxisTable table(order, 4);
  double largest = 0;
  for (int i = 1; i < table.size(); ++i)
    for (int j = 1; j < i; ++j)
      if (wavelet_scale(i) == wavelet_scale(j))
        largest =
            std::max(largest, std::abs(table.inner_product(i, j)) /
                                  std::sqrt(table.inner_product(i, i) * table.inner_product(j, j)));
  return largest;
}

TEST(Gram, CorrelationsWithinAScaleAreThoseOfASecondProgram) {
  // It was written before this one, from the definition of the basis alone.
  EXPECT_NEAR(largest_correlation_within_a_scale(1), 0, 1e-12);
  EXPECT_NEAR(largest_correlation_within_a_scale(2), 0.385, 5e-4);
  EXPECT_NEAR(largest_correlation_within_a_scale(3), 0.557, 5e-4);
  EXPECT_NEAR(largest_correlation_within_a_scale(4), 0.686, 5e-4);
}

TEST(BasisNorms, SpanTheFactorThatUniformStepsIgnore) {
  const std::vector<double> norms = basis_norms(Basis{});
  ASSERT_EQ(norms.size(), 128u);
  EXPECT_DOUBLE_EQ(norms[0], 1);
  // Smallest squared norm 1.95e-3 by the same program, 1 : 0.044.
  EXPECT_NEAR(*std::min_element(norms.begin(), norms.end()), 0.044, 5e-4);
  // w_1 of order 2 is a triangle wave between -1 and 1: mean square 1/3.
  EXPECT_NEAR(norms[1], std::sqrt(1.0 / 3), 1e-14);
  EXPECT_NEAR(norms[17], 1.0 / 3, 1e-14);
  for (const double norm : basis_norms({BasisId::kBspline, 1, 0, 0})) EXPECT_DOUBLE_EQ(norm, 1);
}

TEST(ColourMatrix, IsOrthonormalAndItsTransposeIsTheDocumentedTransform) {
  const auto m = colour_matrix(ColourTransform::kOpponent);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      EXPECT_NEAR(m[0][i] * m[0][j] + m[1][i] * m[1][j] + m[2][i] * m[2][j], i == j, 1e-15);
  // Transposed: (R + G + B) / sqrt 3, (R - B) / sqrt 2, (R - 2G + B) / sqrt 6 of (1, 2, 4).
  const auto coded = [&](std::size_t c) { return m[0][c] * 1 + m[1][c] * 2 + m[2][c] * 4; };
  EXPECT_NEAR(coded(0), 7 / std::sqrt(3.0), 1e-14);
  EXPECT_NEAR(coded(1), -3 / std::sqrt(2.0), 1e-14);
  EXPECT_NEAR(coded(2), 1 / std::sqrt(6.0), 1e-14);
  EXPECT_EQ(colour_matrix(ColourTransform::kNone)[1][1], 1);
  EXPECT_EQ(colour_matrix(ColourTransform::kNone)[1][2], 0);
}

}  // namespace
}  // namespace slf::basis_test
