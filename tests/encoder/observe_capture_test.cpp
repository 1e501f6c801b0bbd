// SPDX-License-Identifier: Apache-2.0
// Observations of a whole capture, from photographs on disk.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <functional>

#include "observe_support.h"
#include "slf/fit.h"

namespace slf::observe_capture_test {
namespace {

using namespace test;

/// Two cameras on disk, one unit to the left and to the right of the origin, looking along +z.
class ObserveCaptureTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("slf_observe_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder_);
    for (const double x : {-0.2, 0.2}) {
      Camera camera = small_camera();
      camera.name = x < 0 ? "left" : "right";
      camera.translation = {-x, 0, 0};
      capture_.cameras.push_back(camera);
      capture_.image_files.push_back(folder_ / (camera.name + ".png"));
      ASSERT_TRUE(write_png(capture_.image_files.back(), ramp()));
    }
    for (int i = 0; i < 40; ++i) {
      points_.positions.push_back(at(0.3 + 0.19 * i, 3.1, 2 + 0.01 * i));
      points_.normals.push_back(kTowards);
    }
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path folder_;
  Capture capture_;
  ObservedPoints points_;
};

TEST_F(ObserveCaptureTest, GroupsByPointWithCamerasAscending) {
  const std::vector<int> cameras{1, 0, 1};  // order and repetition do not matter
  const auto seen = observe(capture_, cameras, points_, {}, 0.1, {});
  ASSERT_TRUE(seen) << seen.error().message;
  ASSERT_EQ(seen->first.size(), 41u);
  EXPECT_EQ(seen->first.back(), seen->camera.size());
  for (std::size_t p = 0; p < 40; ++p) {
    const double u = 0.3 + 0.19 * static_cast<double>(p),
                 shift = 2 / (2 + 0.01 * static_cast<double>(p));
    std::vector<std::uint16_t> expected;
    if (u + shift < 8) expected.push_back(0);  // the left camera sees a point further right
    if (u - shift >= 0) expected.push_back(1);
    const std::vector<std::uint16_t> found(
        seen->camera.begin() + static_cast<std::ptrdiff_t>(seen->first[p]),
        seen->camera.begin() + static_cast<std::ptrdiff_t>(seen->first[p + 1]));
    EXPECT_EQ(found, expected) << "point " << p;
  }
  EXPECT_LT(seen->gamma_max, -0.9);
  EXPECT_LE(seen->gamma_min, seen->gamma_max);
}

TEST_F(ObserveCaptureTest, DoesNotDependOnTheNumberOfThreads) {
  const std::vector<int> cameras{0, 1};
  ObserveSettings settings;
  settings.threads = 1;
  const auto one = observe(capture_, cameras, points_, points_.positions, 0.05, settings);
  settings.threads = 7;
  const auto seven = observe(capture_, cameras, points_, points_.positions, 0.05, settings);
  ASSERT_TRUE(one && seven);
  EXPECT_EQ(one->first, seven->first);
  EXPECT_EQ(one->direction, seven->direction);
  EXPECT_EQ(one->colour, seven->colour);
  EXPECT_EQ(one->camera, seven->camera);
}

TEST_F(ObserveCaptureTest, SaysWhyNothingIsSeen) {
  const std::vector<int> cameras{0, 1};
  ObservedPoints away = points_;
  for (auto& normal : away.normals) normal = {0, 0, 1};
  const auto seen = observe(capture_, cameras, away, {}, 0.1, {});
  ASSERT_FALSE(seen);
  EXPECT_EQ(seen.error().code, Errc::kInvalidInput);
  EXPECT_NE(seen.error().message.find("2 cameras x 40 points, 0 face"), std::string::npos)
      << seen.error().message;
}

TEST_F(ObserveCaptureTest, RefusesBadArgumentsAndMissingImages) {
  const std::vector<int> cameras{0, 1};
  const auto code = [&](const ObserveSettings& settings, double spacing = 0.1) {
    const auto seen = observe(capture_, cameras, points_, {}, spacing, settings);
    return seen ? Errc::kNotSlf : seen.error().code;
  };
  ObserveSettings bad;
  bad.delta_degrees = 91;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  bad = {};
  bad.occlusion_resolution = 9;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  bad = {};
  bad.depth_tolerance = NAN;
  EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  EXPECT_EQ(code({}, 0), Errc::kInvalidArgument);
  const std::vector<int> foreign{0, 2};
  EXPECT_EQ(observe(capture_, foreign, points_, {}, 0.1, {}).error().code, Errc::kInvalidArgument);
  ObservedPoints no_normals = points_;
  no_normals.normals.clear();
  EXPECT_EQ(observe(capture_, cameras, no_normals, {}, 0.1, {}).error().code,
            Errc::kInvalidArgument);
  std::filesystem::remove(capture_.image_files[1]);
  EXPECT_EQ(code({}), Errc::kUnreadable);
}

}  // namespace
}  // namespace slf::observe_capture_test
