// SPDX-License-Identifier: Apache-2.0
// Division by a quantiser's step without one.
#include "attributes/quantiser_step.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace slf::quantiser_step_test {
namespace {

std::vector<std::uint32_t> steps() {
  std::vector<std::uint32_t> all = {1, 3, 5, 7, 90, 641, 6700417, (1u << 27) - 1};
  for (int bits = 1; bits < 27; ++bits)
    for (std::uint32_t step : {(1u << bits) - 1, 1u << bits, (1u << bits) + 1}) all.push_back(step);
  return all;
}

TEST(QuantiserStep, DividesAsADivisionDoes) {
  for (const std::uint32_t step : steps()) {
    const QuantiserStep by(step);
    for (const std::uint64_t near :
         {std::uint64_t{0}, std::uint64_t{step}, std::uint64_t{1} << 31, std::uint64_t{0xFFFFFFFF},
          0xFFFFFFFFu / step * std::uint64_t{step}, std::uint64_t{1} << 38})
      for (std::uint64_t n = near > 3 ? near - 3 : 0; n <= near + 3; ++n)
        ASSERT_EQ(by.divide(n), n / step) << n << " by " << step;
  }
}

TEST(Spec_8_7_4_Quantise, TakesTheNearestThatADecoderAccepts) {
  EXPECT_EQ(QuantiserStep(4).quantise(6), 2);
  EXPECT_EQ(QuantiserStep(4).quantise(-6), -2);
  EXPECT_EQ(QuantiserStep(4).quantise(5), 1);
  EXPECT_EQ(QuantiserStep(1).quantise(-2147483647 - 1), -((1 << 27) - 1));
  EXPECT_EQ(QuantiserStep(90).quantise(2147483647), ((1 << 27) - 1) / 90);
}

}  // namespace
}  // namespace slf::quantiser_step_test
