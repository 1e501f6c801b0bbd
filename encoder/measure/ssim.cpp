// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/ssim.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace slf {
namespace {

constexpr int kRadius = 5;
constexpr double kSigma = 1.5;
constexpr double kC1 = 0.01 * 255 * 0.01 * 255, kC2 = 0.03 * 255 * 0.03 * 255;
/// Powers of the five scales, finest first. Wang et al. 2003, section 3.2.
constexpr std::array<double, 5> kPowers = {0.0448, 0.2856, 0.3001, 0.2363, 0.1333};

/// Weighted sums over a window, each an image: of 1, a, b, a^2, b^2, a b.
using Moments = std::array<std::vector<double>, 6>;

std::array<double, 2 * kRadius + 1> gaussian() {
  std::array<double, 2 * kRadius + 1> weights{};
  for (int i = -kRadius; i <= kRadius; ++i)
    weights[static_cast<std::size_t>(i + kRadius)] = std::exp(-i * i / (2 * kSigma * kSigma));
  return weights;
}

/// The separable window over an image, in place.
void blur(std::vector<double>& image, std::vector<double>& rows, int width, int height) {
  static const auto kWeights = gaussian();
  const auto columns = static_cast<std::size_t>(width);
  // to[x] += weight * from[x] over a run; neighbours are other runs, so that both passes vectorise.
  const auto add = [](double* to, const double* from, double weight, std::size_t count) {
    for (std::size_t x = 0; x < count; ++x) to[x] += weight * from[x];
  };
  std::fill(rows.begin(), rows.end(), 0);
  for (int y = 0; y < height; ++y)
    for (int i = -kRadius; i <= kRadius; ++i) {
      const std::size_t at = static_cast<std::size_t>(y) * columns;
      const auto skip = static_cast<std::size_t>(std::abs(i));
      if (skip >= columns) continue;
      add(rows.data() + at + (i < 0 ? skip : 0), image.data() + at + (i > 0 ? skip : 0),
          kWeights[static_cast<std::size_t>(i + kRadius)], columns - skip);
    }
  std::fill(image.begin(), image.end(), 0);
  for (int y = 0; y < height; ++y)
    for (int i = -kRadius; i <= kRadius; ++i) {
      if (y + i < 0 || y + i >= height) continue;
      add(image.data() + static_cast<std::size_t>(y) * columns,
          rows.data() + static_cast<std::size_t>(y + i) * columns,
          kWeights[static_cast<std::size_t>(i + kRadius)], columns);
    }
}

/// Two images and a mask, of one scale.
struct Pair {
  std::vector<float> a, b;
  std::vector<std::uint8_t> mask;
  int width = 0, height = 0;
};

/// Half the size, odd sides rounded up.
Pair halved(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> mask,
            int width, int height) {
  Pair half;
  half.width = (width + 1) / 2;
  half.height = (height + 1) / 2;
  const std::size_t pixels = std::size_t(half.width) * std::size_t(half.height);
  half.a.assign(pixels, 0);
  half.b.assign(pixels, 0);
  half.mask.assign(pixels, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const std::size_t from = std::size_t(y) * std::size_t(width) + std::size_t(x);
      const std::size_t to = std::size_t(y / 2) * std::size_t(half.width) + std::size_t(x / 2);
      if (!mask[from]) continue;
      half.a[to] += a[from];
      half.b[to] += b[from];
      ++half.mask[to];
    }
  for (std::size_t i = 0; i < pixels; ++i) {
    if (half.mask[i] == 0) continue;
    half.a[i] /= static_cast<float>(half.mask[i]);
    half.b[i] /= static_cast<float>(half.mask[i]);
    half.mask[i] = 1;
  }
  return half;
}

}  // namespace

SsimSum ssim(std::span<const float> a, std::span<const float> b, std::span<const std::uint8_t> mask,
             int width, int height) {
  const std::size_t pixels = std::size_t(width) * std::size_t(height);
  Moments moments;
  for (auto& moment : moments) moment.resize(pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!mask[i]) continue;
    const double x = static_cast<double>(a[i]), y = static_cast<double>(b[i]);
    const std::array<double, 6> terms{1, x, y, x * x, y * y, x * y};
    for (std::size_t k = 0; k < terms.size(); ++k) moments[k][i] = terms[k];
  }
  std::vector<double> rows(pixels);
  for (auto& moment : moments) blur(moment, rows, width, height);
  SsimSum result;
  for (std::size_t i = 0; i < pixels; ++i) {
    if (!mask[i]) continue;
    const double scale = 1 / moments[0][i];
    const double mean_a = moments[1][i] * scale, mean_b = moments[2][i] * scale;
    const double variance_a = moments[3][i] * scale - mean_a * mean_a;
    const double variance_b = moments[4][i] * scale - mean_b * mean_b;
    const double covariance = moments[5][i] * scale - mean_a * mean_b;
    const double luminance =
        (2 * mean_a * mean_b + kC1) / (mean_a * mean_a + mean_b * mean_b + kC1);
    const double structure = (2 * covariance + kC2) / (variance_a + variance_b + kC2);
    result.sum += luminance * structure;
    result.structure_sum += structure;
    ++result.count;
  }
  return result;
}

std::optional<double> ms_ssim(std::span<const float> a, std::span<const float> b,
                              std::span<const std::uint8_t> mask, int width, int height) {
  Pair scale;
  double product = 1, powers = 0;  // of the logarithms' weights; the root is taken at the end
  for (std::size_t s = 0; s < kPowers.size(); ++s) {
    const SsimSum similar = ssim(a, b, mask, width, height);
    if (similar.count == 0) return std::nullopt;
    const bool last =
        s + 1 == kPowers.size() || std::min((width + 1) / 2, (height + 1) / 2) < 2 * kRadius + 1;
    const double mean =
        (last ? similar.sum : similar.structure_sum) / static_cast<double>(similar.count);
    product *= std::pow(std::max(mean, 0.0), kPowers[s]);
    powers += kPowers[s];
    if (last) break;
    scale = halved(a, b, mask, width, height);
    a = scale.a;
    b = scale.b;
    mask = scale.mask;
    width = scale.width;
    height = scale.height;
  }
  return std::pow(product, 1 / powers);
}

}  // namespace slf
