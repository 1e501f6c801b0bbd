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
  const auto found = find_step(16, {1, 2}, [](double) -> Measured {
    return InputError{Errc::kInvalidInput, "no"};
  });
  ASSERT_FALSE(found);
}

}  // namespace
}  // namespace slf::rate_control_test
