#include "lightfield/ssim.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace slf {
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

TEST(Ssim, OfTwoFlatImagesIsTheLuminanceTermAlone) {
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

TEST(Ssim, OfAnEmptyMaskIsNothing) {
  const auto a = texture();
  EXPECT_EQ(ssim(a, a, std::vector<std::uint8_t>(kPixels, 0), kSize, kSize).count, 0u);
}

}  // namespace
}  // namespace slf
