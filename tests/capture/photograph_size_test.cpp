// SPDX-License-Identifier: Apache-2.0
// Photographs are read no larger than points need, and no camera is left out for their size.
#include "capture/photograph_size.h"

#include <gtest/gtest.h>

#include <vector>

namespace slf::photograph_size_test {
namespace {

constexpr double kSpacing = 0.01;

/// At `distance` from the origin, where a spacing covers `pixels`.
Camera camera_at(double distance, double pixels) {
  Camera camera;
  camera.width = 4000, camera.height = 3000;
  camera.fx = camera.fy = pixels * distance / kSpacing;
  camera.cx = 2000, camera.cy = 1500;
  camera.translation = {0, 0, distance};
  return camera;
}

TEST(PhotographSize, LeavesTwoPixelsOfASpacingAtLeast) {
  const auto log2_of = [](double pixels) {
    return least_photograph(camera_at(2, pixels), 2, kSpacing);
  };
  EXPECT_EQ(log2_of(1), 0);
  EXPECT_EQ(log2_of(3.9), 0);
  EXPECT_EQ(log2_of(4.1), 1);
  EXPECT_EQ(log2_of(7.9), 1);
  EXPECT_EQ(log2_of(8.1), 2);
  EXPECT_EQ(least_photograph(camera_at(2, 1e6), 2, kSpacing), 5);  // 93 pixels of the lesser side
}

TEST(PhotographSize, IsThatOfTheFileWherePointsAreNotInFront) {
  EXPECT_EQ(least_photograph(camera_at(2, 100), 0, kSpacing), 0);
  EXPECT_EQ(least_photograph(camera_at(2, 100), -1, kSpacing), 0);
}

TEST(PhotographSize, IsByTheNearestPointThatAPhotographShows) {
  Capture capture;
  capture.cameras = {camera_at(2, 9), camera_at(2, 3), camera_at(2, 9)};
  capture.reduction = {0, 0, 1};
  const std::vector<int> cameras = {0, 1, 2};
  const std::vector<std::array<float, 3>> far = {{0, 0, 0}, {900, 0, 0}, {0, 0, -9}};
  const auto small = photographs_for_points(capture, cameras, far, kSpacing);
  ASSERT_TRUE(small);
  EXPECT_EQ(small->reduction, (std::vector<int>{2, 0, 3}));
  EXPECT_EQ(small->cameras[0].width, 1000);
  EXPECT_EQ(small->cameras[1].width, 4000);
  const std::vector<std::array<float, 3>> near = {{0, 0, 0}, {0, 0, -1}};  // half as far away
  EXPECT_EQ(photographs_for_points(capture, cameras, near, kSpacing)->reduction,
            (std::vector<int>{3, 1, 4}));  // 18 pixels, 6 and 18
}

TEST(PhotographSize, IsLeftAsItIsWhereNoneCanBeSmaller) {
  Capture capture;
  capture.cameras = {camera_at(2, 3)};
  EXPECT_FALSE(photographs_for_points(capture, std::vector<int>{0}, {{{0, 0, 0}}}, kSpacing));
  EXPECT_FALSE(photographs_for_points(capture, std::vector<int>{0}, {}, kSpacing));
}

TEST(PhotographSize, IsHalvedUntilItHasNoMorePixelsThanAreAskedFor) {
  Capture capture;
  capture.cameras = {camera_at(2, 3), camera_at(2, 3), camera_at(2, 3)};
  capture.cameras[1].width = 1000;  // 3 megapixels, the others 12
  capture.reduction = {0, 0, 1};
  const auto reduction_within = [&](double megapixels) {
    return photographs_within(capture, megapixels)->reduction;
  };
  EXPECT_EQ(reduction_within(6.5), (std::vector<int>{1, 0, 2}));
  EXPECT_EQ(reduction_within(3), (std::vector<int>{1, 0, 2}));
  EXPECT_EQ(reduction_within(2.9), (std::vector<int>{2, 1, 3}));
  EXPECT_EQ(photographs_within(capture, 6.5)->cameras[0].width, 2000);
  EXPECT_FALSE(photographs_within(capture, 12));
  EXPECT_FALSE(photographs_within(capture, 0));
}

}  // namespace
}  // namespace slf::photograph_size_test
