// SPDX-License-Identifier: Apache-2.0
#include "encoder/rate_control.h"

#include <gtest/gtest.h>

#include <cmath>

namespace slf::rate_control_test {
namespace {

using Measured = Result<double, InputError>;

TEST(FindStep, ReachesAByteGoalOnASmoothCurveInFewTrials) {
  for (const double target : {2e4, 9e4, 5e5}) {
    int trials = 0;
    const auto found =
        find_step(16, {std::log(0.99 * target), std::log(target)}, [&](double q) -> Measured {
          ++trials;
          return std::log(12000 + 1e6 * std::pow(q, -0.9));
        });
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->reached) << target;
    EXPECT_LE(found->value, std::log(target));
    EXPECT_GE(found->value, std::log(0.99 * target));
    EXPECT_LE(trials, 7) << target;
  }
}

TEST(FindStep, ReachesAGoalOnAStaircase) {
  const auto found = find_step(1, {24.9, 25}, [](double q) -> Measured {
    return 30 - 0.05 * std::round(std::log(q) / 0.03);
  });
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->reached);
}

TEST(FindStep, GoesOnWhereFineStepsAreExact) {
  const auto found = find_step(16, {50, 50.05}, [](double q) -> Measured {
    EXPECT_TRUE(q >= kLeastQ && q <= kMostQ) << q;
    return q < 20 ? INFINITY : 70 - 10 * std::log10(q);
  });
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->reached);
}

TEST(FindStep, BeyondTheRangeOfStepsTheNearestIsSaid) {
  const auto small = find_step(16, {99, 100}, [](double) -> Measured { return 5000.0; });
  ASSERT_TRUE(small);
  EXPECT_FALSE(small->reached);
  EXPECT_EQ(small->value, 5000);
  const auto good =
      find_step(16, {60, 61}, [](double q) -> Measured { return 30 - std::log10(q); });
  ASSERT_TRUE(good);
  EXPECT_FALSE(good->reached);
  EXPECT_NEAR(good->q, kLeastQ, 1e-9);
}

TEST(FindStep, AJumpOverTheGoalGivesTheNearerSide) {
  const auto found =
      find_step(16, {100, 101}, [](double q) -> Measured { return q < 20 ? 130.0 : 98.0; });
  ASSERT_TRUE(found);
  EXPECT_FALSE(found->reached);
  EXPECT_EQ(found->value, 98);
}

TEST(FindStep, AnErrorEndsTheSearch) {
  int measured = 0;
  const auto found = find_step(16, {1, 2}, [&](double) -> Measured {
    if (++measured < 3) return 100.0;
    return InputError{Errc::kInvalidInput, "no"};
  });
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, Errc::kInvalidInput);
  EXPECT_EQ(found.error().message, "no");
  EXPECT_EQ(measured, 3);
}

/// 30 dB that rise by 0.5 up to a step of 40 and fall by 2 for each doubling beyond.
double with_a_peak(double q) {
  const double doublings = std::log2(q / 40);
  return doublings > 0 ? 30.5 - 2 * doublings : 30 + 0.5 * std::exp2(doublings);
}

TEST(FindLargestStep, LosesNoMoreThanIsAllowedAgainstTheBestAndNotMuchLess) {
  for (const double loss : {0.1, 0.5, 2.0}) {
    int trials = 0;
    const auto found = find_largest_step(30, loss, [&](double q) -> Measured {
      ++trials;
      return with_a_peak(q);
    });
    ASSERT_TRUE(found);
    EXPECT_TRUE(found->reached);
    EXPECT_LE(found->value, loss);
    EXPECT_GT(found->q, 32);
    EXPECT_LE(with_a_peak(found->q), 30.5);
    EXPECT_GT(with_a_peak(found->q), 30.5 - 1.5 * loss) << loss;
    EXPECT_LE(trials, 6) << loss;
  }
}

TEST(FindLargestStep, GoesDownWhereTheFirstLosesTooMuch) {
  const auto found = find_largest_step(40, 0.1, [](double q) -> Measured { return 40 - 0.02 * q; });
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->reached);
  EXPECT_LE(found->q, 5);
  EXPECT_GT(found->q, 3);
}

TEST(FindLargestStep, IsWithinTheRangeOfStepsWhateverIsMeasured) {
  const auto never = find_largest_step(30, 0.1, [](double) -> Measured { return 10.0; });
  ASSERT_TRUE(never);
  EXPECT_FALSE(never->reached);
  EXPECT_EQ(never->q, kLeastQ);
  const auto always = find_largest_step(30, 0.1, [](double) -> Measured { return 30.0; });
  ASSERT_TRUE(always);
  EXPECT_EQ(always->q, 4096);
  EXPECT_FALSE(find_largest_step(30, 0.1, [](double) -> Measured {
    return InputError{Errc::kInvalidInput, "no"};
  }));
}

}  // namespace
}  // namespace slf::rate_control_test
