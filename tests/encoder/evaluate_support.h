// SPDX-License-Identifier: Apache-2.0
// A plate, and photographs of one colour of it.
#pragma once

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "slf/evaluate.h"
#include "tests/lightfield/render_support.h"

namespace slf::test {

namespace fs = std::filesystem;

inline constexpr int kSize = 32;

/// A grey plate in front of cameras whose photographs have one grey level each.
class EvaluateTest : public testing::Test {
 protected:
  EvaluateTest() {
    std::string name = (fs::temp_directory_path() / "slf_evaluate_XXXXXX").string();
    root_ = mkdtemp(name.data());
    capture_.root = root_;
    for (const Voxel& v : test::plane(32, 0)) {
      capture_.cloud.positions.push_back({float(v[0]), float(v[1]), float(v[2])});
      capture_.cloud.normals.push_back({0, 0, -1});
    }
  }
  ~EvaluateTest() override { fs::remove_all(root_); }

  /// @param channels  4: an alpha of 255 in the left half, 0 in the right
  void add_photograph(std::array<int, 3> colour, int channels = 3) {
    Image image;
    image.width = image.height = kSize;
    image.channels = channels;
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x) {
        for (const int c : colour) image.data.push_back(static_cast<std::uint8_t>(c));
        if (channels == 4) image.data.push_back(x < kSize / 2 ? 255 : 0);
      }
    const std::string number = std::to_string(capture_.cameras.size());
    // One pixel per voxel; the plate of 32 voxels just fills the image.
    Camera camera = frontal_camera(15.5, 15.5, 500, kSize, 1.0);
    camera.name = number + ".png";
    capture_.image_files.push_back(root_ / camera.name);
    capture_.cameras.push_back(camera);
    ASSERT_TRUE(write_png(capture_.image_files.back(), image));
  }

  fs::path root_;
  Capture capture_;
};

}  // namespace slf::test
