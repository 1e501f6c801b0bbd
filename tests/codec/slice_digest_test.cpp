// SPDX-License-Identifier: Apache-2.0
#include "codec/slice_digest.h"

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "base/sha256.h"

namespace slf::slice_digest_test {
namespace {

using Positions = std::vector<Voxel>;

void append(std::vector<std::uint8_t>& bytes, std::uint64_t value, int size) {
  for (int b = 0; b < size; ++b) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * b)));
}

std::uint32_t power(std::size_t exponent) {
  std::uint32_t power = 1;
  while (exponent-- > 0) power *= 0x9E3779B5u;
  return power;
}

TEST(SliceDigest, IsOfTheSumsOfClause7_9) {
  constexpr std::size_t kPoints = 150;  // two runs and a part of one
  Positions positions;
  std::vector<std::int32_t> components;
  std::vector<std::array<std::uint16_t, 2>> normals;
  std::vector<std::uint8_t> bytes;
  std::uint64_t run = 0;
  for (std::size_t p = 0; p < kPoints; ++p) {
    const auto n = static_cast<std::int32_t>(p);
    positions.push_back({n, n * n, 600 - n});
    for (const std::int32_t v : {n - 70, (1 << 26) - n, -(1 << 26) + 5 * n})
      components.push_back(v);
    normals.push_back({static_cast<std::uint16_t>(65535 - p), static_cast<std::uint16_t>(p)});
    const std::array<std::int32_t, 8> numbers = {
        n, n * n, 600 - n, n - 70, (1 << 26) - n, -(1 << 26) + 5 * n, 65535 - n, n};
    run *= 0x9E3779B97F4A7C15u;
    for (std::size_t i = 0; i < numbers.size(); ++i)
      run += std::uint64_t{static_cast<std::uint32_t>(numbers[i])} * power(i + 1);
    if (p % 64 != 63 && p + 1 != kPoints) continue;
    append(bytes, run, 8);
    run = 0;
  }
  Sha256 sha;
  sha.update(bytes);
  EXPECT_EQ(slice_digest(positions, components, normals), sha.finish());
}

TEST(SliceDigest, ChangesWhenPointsChangePlaces) {
  Positions positions(130);
  for (std::size_t p = 0; p < positions.size(); ++p) positions[p] = {static_cast<int>(p), 1, 2};
  const auto sound = slice_digest(positions, {}, {});
  for (std::size_t p = 0; p + 65 < positions.size(); ++p)
    for (const std::size_t other : {p + 1, p + 2, p + 63, p + 64, p + 65}) {
      std::swap(positions[p], positions[other]);
      EXPECT_NE(slice_digest(positions, {}, {}), sound) << p << ' ' << other;
      std::swap(positions[p], positions[other]);
    }
}

TEST(SliceDigest, ChangesWithErrorsThatCancelInSums) {
  const Positions positions(1);
  std::vector<std::int32_t> components(363);
  for (std::size_t j = 0; j < components.size(); ++j)
    components[j] = static_cast<std::int32_t>(j * j % 97) - 48;
  const auto sound = slice_digest(positions, components, {});
  for (std::size_t j = 0; j + 4 <= components.size(); ++j)
    for (const auto& errors :
         {std::array{1, 0, 0, 0}, {1, -1, 0, 0}, {1, -2, 1, 0}, {1, -1, -1, 1}, {1, -3, 3, -1}}) {
      auto damaged = components;
      for (std::size_t i = 0; i < 4; ++i) damaged[j + i] += errors[i];
      EXPECT_NE(slice_digest(positions, damaged, {}), sound) << j;
    }
}

}  // namespace
}  // namespace slf::slice_digest_test
