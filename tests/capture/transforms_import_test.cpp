// SPDX-License-Identifier: Apache-2.0
// transforms.json: of documents and frames, of Blender scenes, of nerfstudio.
#include <gmock/gmock.h>

#include "capture_formats.h"

namespace slf::transforms_import_test {
namespace {

using namespace test;
using ::testing::ElementsAre;

TEST(Transforms, FrameValuesOverrideThoseOfTheDocument) {
  const auto capture = load_with([](const fs::path& p) {
    write_transforms(p, replaced(kTransformsJson, "\"file_path\": \"images/b.png\"",
                                 "\"file_path\": \"images/b.png\", \"fl_x\": 33, \"fl_y\": 44, "
                                 "\"cx\": 7, \"k1\": 0.1, \"p2\": 0.2"));
  });
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->cameras[0].fx, 30);
  EXPECT_EQ(capture->cameras[0].cx, 8.5);
  EXPECT_EQ(capture->cameras[1].fx, 33);
  EXPECT_EQ(capture->cameras[1].fy, 44);
  EXPECT_EQ(capture->cameras[1].cx, 7);
  EXPECT_EQ(capture->cameras[1].cy, 6.5);
  EXPECT_THAT(capture->cameras[1].distortion, ElementsAre(0.1, 0, 0, 0.2));
  EXPECT_THAT(capture->cameras[0].distortion, ElementsAre(0, 0, 0, 0));
  EXPECT_EQ(capture->cameras[0].name, "images/a.png");
}

// nerfstudio's k3 and k4: a camera has the k1 and k2 that come nearest.
TEST(Transforms, HigherRadialTermsAreExpressedByTheFirstTwo) {
  const auto capture = load_with([](const fs::path& p) {
    write_transforms(p, replaced(kTransformsJson, "\"file_path\": \"images/b.png\"",
                                 "\"file_path\": \"images/b.png\", \"fl_x\": 24, \"fl_y\": 24, "
                                 "\"k1\": 0.1, \"k3\": 4, \"k4\": 1"));
  });
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(capture->cameras[0].distortion, ElementsAre(0, 0, 0, 0));
  const Camera& b = capture->cameras[1];
  for (const double x : {0.1, 0.2, 0.3}) {
    const double s = x * x, bent = x * (1 + s * (0.1 + s * s * (4 + s)));
    EXPECT_NEAR((*b.project({-x, 0, 0}))[0], (*b.project({0, 0, 0}))[0] - 24 * bent / 4, 0.5);
  }
  EXPECT_GT(b.distortion[1], 0.5);                       // of k3
  EXPECT_THAT(capture->warnings, ::testing::IsEmpty());  // less than a tenth of a pixel
}

// Blender scenes have no sizes: their photographs are looked for where they are said to be.
TEST(Transforms, SizesAreThoseOfPhotographsInAFolderThatIsNamed) {
  const TemporaryDirectory directory;
  write_images(directory / "elsewhere");
  write_points(directory / "points.ply");
  write_text(directory / "transforms.json", replaced(kTransformsJson, "\"w\": 16, \"h\": 12,", ""));
  EXPECT_FALSE(load_capture(directory.path()));
  CaptureOptions options;
  options.images = directory / "elsewhere";
  const auto capture = load_capture(directory.path(), options);
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->cameras[0].width, kWidth);
  EXPECT_EQ(capture->image_files[1], directory / "elsewhere/b.png");
}

// NeRF's Blender scenes: only a field of view, sizes and masks from RGBA images, two files.
TEST(Transforms, ABlenderSceneTakesSizeAndMaskFromItsImages) {
  const TemporaryDirectory directory;
  const auto scene = [](const std::string& image) {
    return R"({"camera_angle_x": 1.5707963267948966, "frames": [{"file_path": "./)" + image +
           R"(", "rotation": 0.01, "transform_matrix": [[1, 0, 0, 0], [0, 0, -1, -4], [0, 1, 0, 0],
           [0, 0, 0, 1]]}]})";
  };
  write_text(directory / "transforms_train.json", scene("train/r_0"));
  write_text(directory / "transforms_test.json", scene("test/r_0"));
  for (const char* split : {"train", "test"}) {
    fs::create_directories(directory / split);
    Image image = photograph(4);
    image.data[3] = 0;
    ASSERT_TRUE(write_png(directory / split / "r_0.png", image));
  }
  write_points(directory / "points.ply");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->cameras.size(), 2u);
  EXPECT_THAT(*split_cameras(*capture, ""), ElementsAre(0));
  EXPECT_THAT(*split_cameras(*capture, "evaluation"), ElementsAre(1));
  const Camera& camera = capture->cameras[0];
  EXPECT_EQ(camera.name, "train/r_0.png");
  EXPECT_NEAR(camera.fx, 8, 1e-12);  // half of 16 over tan 45 degrees
  EXPECT_NEAR(camera.fy, 8, 1e-12);
  EXPECT_EQ(camera.cx, 8);
  EXPECT_EQ(camera.cy, 6);
  // At (0, -4, 0), looking along +y, z up: a point to the right and above.
  const auto at = camera.project({1, 0, 2});
  ASSERT_TRUE(at);
  EXPECT_NEAR((*at)[0], 8 + 8 * 0.25, 1e-12);
  EXPECT_NEAR((*at)[1], 6 - 8 * 0.5, 1e-12);
  EXPECT_EQ(capture->up, UpAxis::kPlusZ);
  const auto image = load_image(*capture, 0);
  ASSERT_TRUE(image);
  EXPECT_EQ(image->channels, 4);
  EXPECT_EQ(image->data[3], 0);
}

TEST(Transforms, ThePlyOfNerfstudioIsReadAsItIs) {
  const TemporaryDirectory directory;
  write_transforms(directory.path(),
                   replaced(kTransformsJson, "\"fl_x\"",
                            "\"applied_transform\": [[0, 1, 0, 0], [1, 0, 0, 0], [0, 0, -1, 0]], "
                            "\"ply_file_path\": \"sparse_pc.ply\", \"camera_model\": \"OPENCV\", "
                            "\"fl_x\""));
  fs::rename(directory / "points.ply", directory / "sparse_pc.ply");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->cloud.positions[1], (std::array<float, 3>{0.125f, 0.25f, 0}));
}

}  // namespace
}  // namespace slf::transforms_import_test
