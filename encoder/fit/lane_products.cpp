// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/lane_products.h"

#include <algorithm>
#include <array>
#include <cstring>

#include "base/multiversion.h"

namespace slf {
namespace {

using ProductLanes [[gnu::vector_size(kProductLanes * sizeof(float))]] = float;
using FourLanes [[gnu::vector_size(4 * sizeof(float))]] = float;

/// Rows of c that are summed together: with sixteen lanes each they fit the registers of AVX2.
constexpr std::size_t kTileRows = 4;
/// Terms of the sums after which others have their turn: of a they stay in the cache.
constexpr std::size_t kTerms = 256;

/// A tile of c.
inline void add_tile(std::size_t count, const float* b, std::size_t b_stride, const float* a,
                     std::size_t a_stride, float* c) {
  ProductLanes sum[kTileRows];
  for (std::size_t r = 0; r < kTileRows; ++r) std::memcpy(&sum[r], c + r * a_stride, sizeof sum[r]);
  for (std::size_t q = 0; q < count; ++q) {
    ProductLanes x;
    std::memcpy(&x, a + q * a_stride, sizeof x);
    for (std::size_t r = 0; r < kTileRows; ++r) sum[r] += b[q * b_stride + r] * x;
  }
  for (std::size_t r = 0; r < kTileRows; ++r) std::memcpy(c + r * a_stride, &sum[r], sizeof sum[r]);
}

}  // namespace

SLF_MULTIVERSION_LANES
void add_products(std::size_t count, const float* b, std::size_t b_stride, std::size_t rows,
                  const float* a, std::size_t a_stride, std::size_t columns, float* c) {
  for (std::size_t q = 0; q < count; q += kTerms)
    for (std::size_t i = 0; i < rows; i += kTileRows)
      for (std::size_t j = 0; j < columns; j += kProductLanes)
        add_tile(std::min(kTerms, count - q), b + q * b_stride + i, b_stride, a + q * a_stride + j,
                 a_stride, c + i * a_stride + j);
}

SLF_MULTIVERSION_LANES
void add_square(std::size_t count, const float* a, std::size_t width, float* c) {
  for (std::size_t q = 0; q < count; q += kTerms)
    for (std::size_t i = 0; i < width; i += kTileRows)
      for (std::size_t j = 0; j < i + kTileRows; j += kProductLanes)
        add_tile(std::min(kTerms, count - q), a + q * width + i, width, a + q * width + j, width,
                 c + i * width + j);
}

SLF_MULTIVERSION_LANES
void centre_rows(std::size_t count, float* rows, std::size_t width, float* mean) {
  std::fill_n(mean, width, 0.0f);
  for (std::size_t m = 0; m < count; ++m)
    for (std::size_t j = 0; j < width; ++j) mean[j] += rows[m * width + j];
  for (std::size_t j = 0; j < width; ++j) mean[j] /= static_cast<float>(count);
  for (std::size_t m = 0; m < count; ++m)
    for (std::size_t j = 0; j < width; ++j) rows[m * width + j] -= mean[j];
}

SLF_MULTIVERSION_LANES
void row_products(std::size_t count, const float* rows, std::size_t width, std::size_t n,
                  const Lanes<float>* x, Lanes<float>* y) {
  constexpr std::size_t kRows = 8;  // sums that do not wait for each other
  for (std::size_t q = 0; q < count; q += kRows) {
    const std::size_t some = std::min(kRows, count - q);
    std::array<FourLanes, kRows> sum{};
    const auto add = [&](std::size_t r, std::size_t m, const FourLanes& v) {
      sum[r] += rows[(q + r) * width + m] * v;
    };
    for (std::size_t m = 0; m < n; ++m) {
      FourLanes v;
      std::memcpy(&v, x[m].c.data(), sizeof v);
      if (some == kRows)
        for (std::size_t r = 0; r < kRows; ++r) add(r, m, v);
      else
        for (std::size_t r = 0; r < some; ++r) add(r, m, v);
    }
    std::memcpy(y[q].c.data(), sum.data(), some * sizeof sum[0]);
  }
}

}  // namespace slf
