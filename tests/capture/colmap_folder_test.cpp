// SPDX-License-Identifier: Apache-2.0
// Folders as COLMAP and the programs around it leave them.
#include <gmock/gmock.h>

#include "capture_formats.h"

namespace slf::colmap_folder_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> names(const Capture& capture) {
  std::vector<std::string> out;
  for (const Camera& camera : capture.cameras) out.push_back(camera.name);
  return out;
}

const std::string kWithoutFeatures =
    "12 1 0 0 0 0 0 4 7 b.png\n5 0.5 0.1 -0.7 0.5 0.1 -0.2 3 7 a.png\n";

TEST(ColmapFolder, ImagesHaveLinesOfFeaturesOrNone) {
  for (const std::string& images :
       {kImagesTxt, kWithoutFeatures, "\xEF\xBB\xBF" + kImagesTxt,
        std::string("12 1 0 0 0 0 0 4 7 b.png\n1 2 -1\n5 0.5 0.1 -0.7 0.5 0.1 -0.2 3 7 a.png")}) {
    const auto capture =
        load_with([&](const fs::path& p) { write_colmap_text(p, kCamerasTxt, images); });
    ASSERT_TRUE(capture) << capture.error().message << images;
    EXPECT_THAT(names(*capture), ElementsAre("a.png", "b.png")) << images;
  }
  const auto damaged = load_with([](const fs::path& p) {
    write_colmap_text(p, kCamerasTxt, "12 1 0 0 0 0 0 4 7 b.png\n1 2 -1 4\n");
  });
  EXPECT_THAT(message_of(damaged), AllOf(HasSubstr("images.txt, line 2"), HasSubstr("POINT3D_ID")));
}

TEST(ColmapFolder, TheLargestOfSeveralModelsIsTaken) {
  const TemporaryDirectory directory;
  write_colmap_text(directory.path(), kCamerasTxt, "5 0.5 0.1 -0.7 0.5 0.1 -0.2 3 7 a.png\n\n");
  fs::create_directories(directory / "other");
  write_colmap_binary(directory / "other");
  fs::rename(directory / "other/sparse/0", directory / "sparse/1");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->cameras.size(), 2u);
  EXPECT_THAT(capture->warnings, Contains(AllOf(HasSubstr("sparse/1 (2 photographs) is taken"),
                                                HasSubstr("sparse/0 (1 photographs)"))));
  const auto first = load_capture(directory / "sparse/0");
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_EQ(first->cameras.size(), 1u);
  EXPECT_THAT(first->warnings, Contains(HasSubstr("1 of 2 photographs are not in the model")));
}

TEST(ColmapFolder, GeometryIsTheDenseCloudElsePointsInAnyForm) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory.path());
  const auto points = [&] {
    const auto capture = load_capture(directory.path());
    return capture ? capture->cloud.positions.size() : 0;
  };
  EXPECT_EQ(points(), 2u);
  fs::remove(directory / "sparse/0/points3D.bin");
  EXPECT_THAT(message_of(load_capture(directory.path())),
              AllOf(HasSubstr("no point cloud"), HasSubstr("points3D.bin"), HasSubstr("fused.ply"),
                    HasSubstr("--points")));
  write_text(directory / "sparse/0/points3D.txt", kPointsTxt + "7 0 0.125 0.25 1 2 3 0.1\n");
  EXPECT_EQ(points(), 3u);
  fs::remove(directory / "sparse/0/points3D.txt");
  write_points(directory / "sparse/0/points3D.ply");
  EXPECT_EQ(points(), 3u);
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}};
  ASSERT_TRUE(write_ply(directory / "fused.ply", cloud));
  EXPECT_EQ(points(), 1u);
}

TEST(ColmapFolder, NerfstudiosIsFoundBehindItsOwnFormat) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory.path());
  fs::create_directories(directory / "colmap");
  fs::rename(directory / "sparse", directory / "colmap/sparse");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->image_files[0], directory / "images/a.png");
}

TEST(ColmapFolder, MasksAreFoundByTheNamesOfPhotographs) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory.path());
  Image mask{kWidth, kHeight, 3, std::vector<std::uint8_t>(3 * kWidth * kHeight, 1)};
  mask.data[0] = mask.data[1] = mask.data[2] = 0;
  fs::create_directories(directory / "masks");
  ASSERT_TRUE(write_png(directory / "masks/a.png.png", mask));
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(capture->warnings, Contains(HasSubstr("no mask of 1 of 2 photographs")));
  const auto image = load_image(*capture, 0);
  ASSERT_TRUE(image);
  ASSERT_EQ(image->channels, 4);
  EXPECT_EQ(image->data[3], 0);
  EXPECT_EQ(image->data[7], 255);
}

TEST(ColmapFolder, MasksOfOtherNamesAreNotLeftOutInSilence) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory.path());
  const Image mask{kWidth, kHeight, 3, std::vector<std::uint8_t>(3 * kWidth * kHeight, 1)};
  fs::create_directories(directory / "masks");
  const auto empty = load_capture(directory.path());
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_THAT(empty->warnings, Not(Contains(HasSubstr("mask"))));
  ASSERT_TRUE(write_png(directory / "masks/mask_a.png", mask));
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(capture->warnings, Contains(HasSubstr("named as a.png or a.png.png")));
}

TEST(ColmapFolder, PhotographsMayBeElsewhere) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory / "model");
  fs::rename(directory / "model/images", directory / "photographs");
  EXPECT_FALSE(load_capture(directory / "model"));
  CaptureOptions options;
  options.images = directory / "photographs";
  const auto capture = load_capture(directory / "model", options);
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->image_files[1], directory / "photographs/b.png");
  write_shared(directory / "shared");
  fs::remove_all(directory / "shared/images");
  const auto shared = load_capture(directory / "shared", options);
  ASSERT_TRUE(shared) << shared.error().message;
  EXPECT_EQ(shared->image_files[1], directory / "photographs/b.png");
}

}  // namespace
}  // namespace slf::colmap_folder_test
