// SPDX-License-Identifier: Apache-2.0
// The same two photographs in every format give the same cameras; what cannot be meant is refused.
#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "other_cameras.h"

namespace slf::capture_import_test {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Format {
  const char* name;
  std::function<void(const fs::path&)> write;
};
void PrintTo(const Format& format, std::ostream* out) { *out << format.name; }
class EveryFormat : public testing::TestWithParam<Format> {};

TEST_P(EveryFormat, GivesTheSameCamerasForTheSameSetUp) {
  const TemporaryDirectory directory;
  GetParam().write(directory.path());
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->cameras.size(), 2u);
  const Camera &a = capture->cameras[0], &b = capture->cameras[1];
  EXPECT_THAT(capture->image_files[0].filename(), "a.png");
  EXPECT_THAT(capture->image_files[1].filename(), "b.png");
  const Vec3 centre = a.centre();
  EXPECT_NEAR(centre[0], -2.28, 1e-12);
  EXPECT_NEAR(centre[1], 1.96, 1e-12);
  EXPECT_NEAR(centre[2], -0.1, 1e-12);
  const std::array<Vec3, 3> rotation{{{-0.48, -0.64, -0.6}, {0.36, 0.48, -0.8}, {0.8, -0.6, 0}}};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(a.rotation[i][j], rotation[i][j], 1e-12);
  EXPECT_NEAR(b.centre()[2], -4, 1e-12);
}

// Other axes would put the origin behind the camera or at (7.5, 10.5), another pixel convention at
// (9, 2) or (10, 3).
TEST_P(EveryFormat, PutsTheOriginOnTheMiddleOfThePixelThatShowsIt) {
  const TemporaryDirectory directory;
  GetParam().write(directory.path());
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  double depth = 0;
  const auto at = capture->cameras[0].project({0, 0, 0}, &depth);
  ASSERT_TRUE(at);
  EXPECT_NEAR((*at)[0], 9.5, 1e-12);
  EXPECT_NEAR((*at)[1], 2.5, 1e-12);
  EXPECT_NEAR(depth, 3, 1e-12);
  const auto image = load_image(*capture, 0);
  ASSERT_TRUE(image) << image.error().message;
  EXPECT_EQ(image->data, photograph().data);
  EXPECT_EQ(image->data[3 * (2 * kWidth + 9)], 250);
  // Camera b: x = 0.125, y = 0.25, z = 4.
  const auto other = capture->cameras[1].project({0.125, 0.25, 0});
  ASSERT_TRUE(other);
  EXPECT_NEAR((*other)[0], 30 * 0.125 / 4 + 8.5, 1e-12);
  EXPECT_NEAR((*other)[1], 60 * 0.25 / 4 + 6.5, 1e-12);
}
INSTANTIATE_TEST_SUITE_P(
    Formats, EveryFormat,
    testing::Values(Format{"shared", [](const fs::path& p) { write_shared(p); }},
                    Format{"transforms", [](const fs::path& p) { write_transforms(p); }},
                    Format{"colmap_text", [](const fs::path& p) { write_colmap_text(p); }},
                    Format{"colmap_binary", write_colmap_binary},
                    Format{"metashape", [](const fs::path& p) { write_metashape(p); }}),
    [](const auto& format) { return format.param.name; });

TEST(SharedCapture, NamesItsSplitsAndWarnsOfNothing) {
  const auto capture = load_with([](const fs::path& p) { write_shared(p); });
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(*split_cameras(*capture, ""), ElementsAre(1));
  EXPECT_THAT(*split_cameras(*capture, "evaluation"), ElementsAre(0));
  EXPECT_THAT(*split_cameras(*capture, "all"), ElementsAre(0, 1));
  EXPECT_THAT(capture->warnings, IsEmpty());
  const auto none = split_cameras(*capture, "sparse");
  ASSERT_FALSE(none);
  EXPECT_EQ(none.error().code, Errc::kInvalidArgument);
  EXPECT_THAT(none.error().message, HasSubstr("'sparse'"));
}

TEST(SharedCapture, SaysWhichAxisIsUp) {
  const auto up = [](const std::string& axis) {
    const auto capture = load_with([&](const fs::path& p) {
      write_shared(p,
                   replaced(kCamerasJson, "\"unknown\"", "\"up\": \"" + axis + "\", \"unknown\""));
    });
    return capture ? capture->up : UpAxis::kUnknown;
  };
  EXPECT_EQ(up("-y"), UpAxis::kMinusY);
  EXPECT_EQ(up("+x"), UpAxis::kPlusX);
  // Without it: the mean of -y axes is (-0.18, -0.74, 0.4).
  const auto capture = load_with([](const fs::path& p) { write_shared(p); });
  ASSERT_TRUE(capture);
  EXPECT_EQ(capture->up, UpAxis::kMinusY);
}

TEST(SharedCapture, AMaskGoesIntoAlpha) {
  const TemporaryDirectory directory;
  write_shared(directory.path(), replaced(kCamerasJson, "\"image\": \"images/b.png\"",
                                          "\"image\": \"images/b.png\", \"mask\": \"m.png\""));
  Image mask{kWidth, kHeight, 3, std::vector<std::uint8_t>(3 * kWidth * kHeight, 255)};
  mask.data[0] = mask.data[1] = mask.data[2] = 0;
  ASSERT_TRUE(write_png(directory / "m.png", mask));
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(load_image(*capture, 0)->channels, 3);
  const auto image = load_image(*capture, 1);
  ASSERT_TRUE(image);
  ASSERT_EQ(image->channels, 4);
  EXPECT_EQ(image->data[3], 0);
  EXPECT_EQ(image->data[7], 255);
  EXPECT_EQ(image->data[4], 20);
  EXPECT_FALSE(load_image(*capture, 2));
  EXPECT_FALSE(load_image(*capture, -1));
}

TEST(LoadCapture, ALonePlyIsACloudWithoutCameras) {
  const TemporaryDirectory directory;
  write_points(directory / "cloud.ply");
  const auto capture = load_capture(directory / "cloud.ply");
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_TRUE(capture->cameras.empty());
  EXPECT_EQ(capture->cloud.positions.size(), 3u);
}

TEST(LoadCapture, TakesTheFileItselfAndATrailingSlash) {
  const TemporaryDirectory directory;
  write_shared(directory.path());
  write_transforms(directory.path());
  EXPECT_EQ(load_capture(directory / "cameras.json")->cameras[0].name, "images/a.png");
  EXPECT_TRUE(load_capture(directory / "transforms.json"));
  EXPECT_TRUE(load_capture(directory.path().string() + "/"));
  fs::rename(directory / "transforms.json", directory / "scene.json");
  EXPECT_TRUE(load_capture(directory / "scene.json"));
  EXPECT_THAT(message_of(load_capture(directory / "images/a.png")), HasSubstr("not a capture"));
}

TEST(LoadCapture, WithoutTheCheckOfImagesAMissingOneIsFoundWhenLoaded) {
  const TemporaryDirectory directory;
  write_shared(directory.path());
  fs::remove(directory / "images/b.png");
  CaptureOptions options;
  options.check_images = false;
  const auto capture = load_capture(directory.path(), options);
  ASSERT_TRUE(capture) << capture.error().message;
  const auto image = load_image(*capture, 1);
  ASSERT_FALSE(image);
  EXPECT_EQ(image.error().code, Errc::kUnreadable);
}

TEST(RealCaptures, Load) {
  const fs::path data = test::shared_data();
  if (!fs::exists(data / "blender_can")) GTEST_SKIP() << "no shared captures";
  const auto can = load_capture(data / "blender_can");
  ASSERT_TRUE(can) << can.error().message;
  EXPECT_EQ(can->cameras.size(), 251u);
  EXPECT_EQ(can->cloud.normals.size(), 91791u);
  EXPECT_EQ(can->up, UpAxis::kPlusZ);
  EXPECT_EQ(split_cameras(*can, "")->size(), 125u);
  EXPECT_EQ(split_cameras(*can, "evaluation")->size(), 100u);
  EXPECT_THAT(can->warnings, IsEmpty());
  EXPECT_NEAR(std::hypot(can->cameras[0].centre()[0], can->cameras[0].centre()[1],
                         can->cameras[0].centre()[2]),
              5, 1e-9);  // README: a sphere of radius 5
  const auto dino = load_capture(data / "middlebury_dino");
  ASSERT_TRUE(dino) << dino.error().message;
  EXPECT_EQ(dino->cameras.size(), 121u);
  EXPECT_THAT(dino->warnings, IsEmpty());
  EXPECT_EQ(load_image(*dino, 0)->width, 640);
}

}  // namespace
}  // namespace slf::capture_import_test
