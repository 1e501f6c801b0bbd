#include "lightfield/ssim.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace slf {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;

/// Weighted sums over a window: of 1, a, b, a^2, b^2, a b.
using Moments = std::array<double, 6>;

std::array<double, 2 * kRadius + 1> gaussian() {
  std::array<double, 2 * kRadius + 1> weights{};
  for (int i = -kRadius; i <= kRadius; ++i)
    weights[static_cast<std::size_t>(i + kRadius)] = std::exp(-i * i / (2 * kSigma * kSigma));
  return weights;
}

/// One pass of the separable window along lines of `length` elements, `stride` apart.
void blur(const std::vector<Moments>& from, std::vector<Moments>& to, std::size_t lines,
          std::size_t line_stride, int length, std::size_t stride) {
  static const auto kWeights = gaussian();
  for (std::size_t line = 0; line < lines; ++line)
    for (int at = 0; at < length; ++at) {
      Moments sum{};
      for (int i = -kRadius; i <= kRadius; ++i) {
        if (at + i < 0 || at + i >= length) continue;
        const Moments& m = from[line * line_stride + static_cast<std::size_t>(at + i) * stride];
        const double weight = kWeights[static_cast<std::size_t>(i + kRadius)];
        for (std::size_t k = 0; k < sum.size(); ++k) sum[k] += weight * m[k];
      }
      to[line * line_stride + static_cast<std::size_t>(at) * stride] = sum;
    }
}

double similarity(const Moments& m) {
  const double mean_a = m[1] / m[0], mean_b = m[2] / m[0];
  const double variance_a = m[3] / m[0] - mean_a * mean_a;
  const double variance_b = m[4] / m[0] - mean_b * mean_b;
  const double covariance = m[5] / m[0] - mean_a * mean_b;
  return (2 * mean_a * mean_b + kC1) * (2 * covariance + kC2) /
         ((mean_a * mean_a + mean_b * mean_b + kC1) * (variance_a + variance_b + kC2));
}

}  // namespace

SsimSum ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> mask,
             int width, int height) {
  const auto columns = static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<Moments> moments(columns * rows), blurred(columns * rows);
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (!mask[i]) continue;
    const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    moments[i] = {1, x, y, x * x, y * y, x * y};
  }
  blur(moments, blurred, rows, columns, width, 1);
  blur(blurred, moments, columns, 1, height, columns);
  SsimSum result;
  for (std::size_t i = 0; i < moments.size(); ++i) {
    if (!mask[i]) continue;
    result.sum += similarity(moments[i]);
    ++result.count;
  }
  return result;
}

}  // namespace slf
