// SPDX-License-Identifier: Apache-2.0
// What the cells of a base weigh. Spec 8.4.5.
#include "geometry/weight_classes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "geometry/encoder/octree_encoder.h"
#include "geometry/octree_decoder.h"
#include "tests/codec/field_support.h"

namespace slf::weight_classes_test {
namespace {

constexpr int kLevels = 4;

std::vector<std::uint8_t> coded(const std::vector<std::uint64_t>& cells,
                                const std::vector<std::uint8_t>& classes) {
  OctreeEncoder encoder(cells, kLevels, OccupancyStates(cells.size()));
  return encoder.encode(kLevels, classes);
}

Result<std::vector<std::uint8_t>> decoded(std::span<const std::uint8_t> payload,
                                          std::size_t cells) {
  OctreeDecoder decoder(kLevels, cells, OccupancyStates(cells));
  return decoder.decode_with_classes(payload, kLevels);
}

TEST(Spec_8_4_5_WeightClasses, AreTheNearestLogarithms) {
  for (std::uint64_t points = 1; points <= 70000; ++points)
    ASSERT_EQ(weight_class(points), std::lround(std::log2(static_cast<double>(points)))) << points;
  EXPECT_EQ(weight_class(std::uint64_t{1} << 22), kMostWeightClass);
}

TEST(Spec_8_4_5_WeightClasses, DecodeToWhatWasEncoded) {
  const auto cells = test::codes(test::sphere_cloud(kLevels));
  std::mt19937 random(1);
  for (const unsigned kinds : {1u, 2u, 8u, 14u})
    for (const unsigned least : {0u, 3u}) {
      std::vector<std::uint8_t> classes;
      for (std::size_t i = 0; i < cells.size(); ++i)
        classes.push_back(static_cast<std::uint8_t>(least + random() % kinds));
      const auto result = decoded(coded(cells, classes), cells.size());
      ASSERT_TRUE(result) << to_string(result.error());
      EXPECT_EQ(*result, classes);
    }
}

TEST(Spec_8_4_5_WeightClasses, WeighAtMost2To24Together) {
  const std::vector<std::uint64_t> cells = {0, 1, 9, 100, 4095};
  const std::vector<std::uint8_t> most = {22, 22, 22, 21, 21}, more = {22, 22, 22, 21, 22};
  const auto result = decoded(coded(cells, most), cells.size());
  ASSERT_TRUE(result) << to_string(result.error());
  EXPECT_EQ(*result, most);
  EXPECT_EQ(weights_before(most).back(), kMostBaseWeight);
  const auto refused = decoded(coded(cells, more), cells.size());
  ASSERT_FALSE(refused);
  EXPECT_STREQ(refused.error().element, "gu_weight_class");
  EXPECT_EQ(refused.error().code, Errc::kOutOfRange);
}

TEST(Spec_8_4_5_WeightClasses, EveryTruncationAndWhatFollowsAreReported) {
  const auto cells = test::codes(test::sphere_cloud(kLevels));
  std::vector<std::uint8_t> classes;
  for (const std::uint64_t cell : cells) classes.push_back(static_cast<std::uint8_t>(cell % 9));
  auto payload = coded(cells, classes);
  for (std::size_t size = 0; size < payload.size(); ++size) {
    const auto cut =
        decoded(std::vector(payload.begin(), payload.begin() + std::ptrdiff_t(size)), cells.size());
    ASSERT_TRUE(!cut || *cut != classes) << size;
    if (cut) continue;
    const std::string element = cut.error().element;
    EXPECT_TRUE(element == "gu_weight_class" || element == "gu_occupancy") << element;
  }
  payload.insert(payload.end(), 5, 0x55);  // four could be the decoder's register
  const auto longer = decoded(payload, cells.size());
  ASSERT_FALSE(longer);
  EXPECT_STREQ(longer.error().element, "gu_weight_class");
  EXPECT_EQ(longer.error().code, Errc::kOutOfRange);
}

}  // namespace
}  // namespace slf::weight_classes_test
