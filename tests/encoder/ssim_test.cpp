// SPDX-License-Identifier: Apache-2.0
#include "encoder/measure/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace slf::ssim_test {
namespace {

constexpr int kSize = 24;
constexpr std::size_t kPixels = kSize * kSize;

std::vector<float> texture() {
  std::vector<float> image;
  for (int y = 0; y < kSize; ++y)
    for (int x = 0; x < kSize; ++x)
      image.push_back(static_cast<float>(128 + 60 * std::sin(0.9 * x) * std::cos(0.7 * y)));
  return image;
}

double mean(const SsimSum& s) { return s.sum / static_cast<double>(s.count); }

TEST(Ssim, IsOneForEqualImages) {
  const auto image = texture();
  const SsimSum s = ssim(image, image, std::vector<std::uint8_t>(kPixels, 1), kSize, kSize);
  EXPECT_EQ(s.count, kPixels);
  EXPECT_NEAR(mean(s), 1, 1e-12);
}

TEST(Ssim, TwoFlatImagesHaveTheLuminanceTermAlone) {
  const std::vector<float> a(kPixels, 100), b(kPixels, 120);
  const double c1 = 0.01 * 255 * 0.01 * 255;
  const SsimSum s = ssim(a, b, std::vector<std::uint8_t>(kPixels, 1), kSize, kSize);
  EXPECT_NEAR(mean(s), (2 * 100 * 120 + c1) / (100 * 100 + 120 * 120 + c1), 1e-9);
}

TEST(Ssim, FallsBelowZeroWhereStructureIsInverted) {
  const auto a = texture();
  std::vector<float> b;
  for (const float v : a) b.push_back(255 - v);
  EXPECT_LT(mean(ssim(a, b, std::vector<std::uint8_t>(kPixels, 1), kSize, kSize)), -0.5);
}

TEST(Ssim, WhatLiesOutsideTheMaskDoesNotCount) {
  const auto a = texture();
  auto b = a;
  std::vector<std::uint8_t> mask(kPixels, 1);
  for (std::size_t i = 0; i < kPixels; ++i) {
    b[i] += 3 * static_cast<float>(i % 5);
    if (i % kSize >= kSize / 2) mask[i] = 0;
  }
  const SsimSum before = ssim(a, b, mask, kSize, kSize);
  for (std::size_t i = 0; i < kPixels; ++i)
    if (!mask[i]) b[i] = 255;
  const SsimSum after = ssim(a, b, mask, kSize, kSize);
  EXPECT_EQ(after.count, kPixels / 2);
  EXPECT_EQ(before.sum, after.sum);
  EXPECT_LT(mean(after), 1);
}

TEST(Ssim, AnEmptyMaskHasNone) {
  const auto a = texture();
  EXPECT_EQ(ssim(a, a, std::vector<std::uint8_t>(kPixels, 0), kSize, kSize).count, 0u);
}

/// Two images of noise, so that similarity differs from scale to scale.
struct MultiScale : testing::Test {
  static std::vector<float> noise(int size, unsigned seed) {
    std::vector<float> image;
    for (int i = 0; i < size * size; ++i) {
      seed = seed * 1664525u + 1013904223u;
      image.push_back(static_cast<float>(seed >> 24));
    }
    return image;
  }
  static std::optional<double> of(const std::vector<float>& a, const std::vector<float>& b,
                                  int size) {
    return ms_ssim(a, b, std::vector<std::uint8_t>(a.size(), 1), size, size);
  }
};

TEST_F(MultiScale, IsOneForEqualImages) {
  const auto image = noise(200, 1);
  EXPECT_NEAR(*of(image, image, 200), 1, 1e-12);
}

TEST_F(MultiScale, IsThatOfOneScaleWhereTheNextIsSmallerThanTheWindow) {
  const auto a = noise(20, 1);
  auto b = a;
  for (float& v : b) v = 0.5f * v + 40;
  const SsimSum one = ssim(a, b, std::vector<std::uint8_t>(400, 1), 20, 20);
  EXPECT_NEAR(*of(a, b, 20), mean(one), 1e-12);
}

TEST_F(MultiScale, ABrighterFlatImageHasTheLuminanceOfTheLastScale) {
  const int size = 176;  // its fifth scale is as large as the window
  const std::vector<float> a(size * size, 100), b(size * size, 120);
  const double c1 = 0.01 * 255 * 0.01 * 255;
  const double luminance = (2 * 100 * 120 + c1) / (100 * 100 + 120 * 120 + c1);
  EXPECT_NEAR(*of(a, b, size),
              std::pow(luminance, 0.1333 / (0.0448 + 0.2856 + 0.3001 + 0.2363 + 0.1333)), 1e-9);
}

TEST_F(MultiScale, FineNoiseCountsLessThanCoarse) {
  const int size = 192;
  const auto a = noise(size, 1), n = noise(size, 2);
  auto fine = a, coarse = a;
  for (int y = 0; y < size; ++y)
    for (int x = 0; x < size; ++x) {
      const auto at = [&](int u, int v) { return std::size_t(v * size + u); };
      fine[at(x, y)] += 0.3f * (n[at(x, y)] - 128);
      coarse[at(x, y)] += 0.3f * (n[at(x / 8, y / 8)] - 128);
    }
  EXPECT_GT(*of(a, fine, size), *of(a, coarse, size) + 0.02);
}

TEST_F(MultiScale, WhatLiesOutsideTheMaskDoesNotCount) {
  const int size = 100;
  const auto a = noise(size, 1);
  auto b = noise(size, 3);
  std::vector<std::uint8_t> mask(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mask[i] = i % 100 < 37;
  const auto before = ms_ssim(a, b, mask, size, size);
  for (std::size_t i = 0; i < a.size(); ++i)
    if (!mask[i]) b[i] = 255;
  EXPECT_EQ(before, ms_ssim(a, b, mask, size, size));
  EXPECT_LT(*before, 1);
}

TEST_F(MultiScale, AnEmptyMaskHasNone) {
  const auto a = noise(30, 1);
  EXPECT_FALSE(ms_ssim(a, a, std::vector<std::uint8_t>(900, 0), 30, 30));
}

}  // namespace
}  // namespace slf::ssim_test
