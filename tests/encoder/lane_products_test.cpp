// SPDX-License-Identifier: Apache-2.0
// The sums of products that the fit is made of, against loops of doubles.
#include "encoder/fit/lane_products.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "encoder/fit/fit_cholesky.h"

namespace slf::lane_products_test {
namespace {

std::vector<float> random_values(std::size_t count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> value(-1, 1);
  std::vector<float> values(count);
  for (float& x : values) x = value(random);
  return values;
}

constexpr double kRounding = 2e-4;

TEST(LaneProducts, AreTheSumsOfProductsAddedToWhatWasThere) {
  constexpr std::size_t kCount = 300, kRows = 8, kWidth = 48;  // more terms than are taken at once
  const auto b = random_values(kCount * kRows), a = random_values(kCount * kWidth);
  std::vector<float> c(kRows * kWidth, 2.0f);
  add_products(kCount, b.data(), kRows, kRows, a.data(), kWidth, kWidth, c.data());
  for (std::size_t i = 0; i < kRows; ++i)
    for (std::size_t j = 0; j < kWidth; ++j) {
      double sum = 2;
      for (std::size_t q = 0; q < kCount; ++q)
        sum += double{b[q * kRows + i]} * double{a[q * kWidth + j]};
      EXPECT_NEAR(double{c[i * kWidth + j]}, sum, kRounding) << i << ' ' << j;
    }
}

TEST(LaneProducts, ProductsOfAMatrixWithItselfHaveTheirLowerTriangle) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{5}, std::size_t{600}}) {
    constexpr std::size_t kWidth = 48;
    const auto a = random_values(count * kWidth);
    std::vector<float> c(kWidth * kWidth, 0.0f);
    add_square(count, a.data(), kWidth, c.data());
    for (std::size_t i = 0; i < kWidth; ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        double sum = 0;
        for (std::size_t q = 0; q < count; ++q)
          sum += double{a[q * kWidth + i]} * double{a[q * kWidth + j]};
        EXPECT_NEAR(double{c[i * kWidth + j]}, sum, kRounding) << i << ' ' << j;
      }
  }
}

TEST(LaneProducts, ProductsOfRowsReadTheirFirstElementsAlone) {
  constexpr std::size_t kCount = 11, kWidth = 16, kUsed = 13;  // not whole groups of rows
  const auto rows = random_values(kCount * kWidth);
  std::vector<Lanes<float>> x(kUsed), y(kCount);
  for (std::size_t m = 0; m < kUsed; ++m)
    for (std::size_t c = 0; c < 4; ++c) x[m].c[c] = static_cast<float>(m + c);
  row_products(kCount, rows.data(), kWidth, kUsed, x.data(), y.data());
  for (std::size_t q = 0; q < kCount; ++q)
    for (std::size_t c = 0; c < 4; ++c) {
      double sum = 0;
      for (std::size_t m = 0; m < kUsed; ++m)
        sum += double{rows[q * kWidth + m]} * static_cast<double>(m + c);
      EXPECT_NEAR(double{y[q].c[c]}, sum, kRounding) << q << ' ' << c;
    }
}

TEST(LaneProducts, CentredRowsHaveNoMean) {
  constexpr std::size_t kCount = 7, kWidth = 16;
  auto rows = random_values(kCount * kWidth);
  const auto before = rows;
  std::vector<float> mean(kWidth);
  centre_rows(kCount, rows.data(), kWidth, mean.data());
  for (std::size_t j = 0; j < kWidth; ++j) {
    double sum = 0;
    for (std::size_t m = 0; m < kCount; ++m) {
      sum += double{rows[m * kWidth + j]};
      EXPECT_EQ(rows[m * kWidth + j], before[m * kWidth + j] - mean[j]);
    }
    EXPECT_NEAR(sum, 0, kRounding);
  }
}

/// L L^T x = b for every size, so that pairs of columns and groups of sums have their rests.
template <class Real, class Right>
void solves(double precision) {
  for (std::size_t n = 1; n < 14; ++n) {
    std::vector<Real> matrix(packed_size(n));
    for (std::size_t j = 0; j < n; ++j)
      for (std::size_t i = j; i < n; ++i)
        matrix[packed_column(n, j) + i - j] = static_cast<Real>(
            i == j ? 4 + static_cast<double>(i) : 1 / (1.0 + static_cast<double>(i + j)));
    std::vector<Right> x(n);
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < x[i].c.size(); ++c)
        x[i].c[c] = static_cast<Real>(i) - static_cast<Real>(c);
    const auto b = x;
    auto factor = matrix;
    cholesky_factorise(factor.data(), n, Real{1});
    cholesky_solve(factor.data(), n, x.data());
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t c = 0; c < b[i].c.size(); ++c) {
        double sum = 0;
        for (std::size_t k = 0; k < n; ++k)
          sum +=
              double(matrix[packed_column(n, std::min(i, k)) + std::max(i, k) - std::min(i, k)]) *
              double(x[k].c[c]);
        EXPECT_NEAR(sum, double(b[i].c[c]), precision) << n << ' ' << i << ' ' << c;
      }
  }
}

TEST(Cholesky, SolvesSystemsOfAnySize) {
  solves<float, Lanes<float>>(1e-4);
  solves<float, ManyLanes>(1e-4);
  solves<double, Lanes<double>>(1e-12);
}

}  // namespace
}  // namespace slf::lane_products_test
