// The same two photographs in every format give the same cameras; what cannot be meant is refused.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <functional>

#include "capture_formats.h"

namespace slf {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

struct Format {
  const char* name;
  std::function<void(const fs::path&)> write;
};
class EveryFormat : public testing::TestWithParam<Format> {};

TEST_P(EveryFormat, GivesTheSameCamerasForTheSameSetUp) {
  const TemporaryDirectory directory;
  GetParam().write(directory.path());
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->cameras.size(), 2u);
  const Camera &a = capture->cameras[0], &b = capture->cameras[1];
  EXPECT_THAT(a.name, HasSubstr("a.png"));
  EXPECT_THAT(b.name, HasSubstr("b.png"));
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
                    Format{"colmap_binary", write_colmap_binary}),
    [](const auto& format) { return format.param.name; });

// -- Camera ------------------------------------------------------------------------------------

TEST(CameraProject, HonoursBrownDistortionAsColmapsOpencvModel) {
  Camera camera;
  camera.fx = 100;
  camera.fy = 200;
  camera.cx = 10;
  camera.cy = 20;
  camera.distortion = {0.1, 0.01, 0.002, 0.003};
  // x = 0.5, y = -1, r^2 = 1.25: radial 0.125 + 0.015625 = 0.140625;
  // dx = 0.0703125 + 2*0.002*-0.5 + 0.003*(1.25 + 0.5)   = 0.0735625
  // dy = -0.140625 + 2*0.003*-0.5 + 0.002*(1.25 + 2)     = -0.137125
  const auto at = camera.project({1, -2, 2});
  ASSERT_TRUE(at);
  EXPECT_NEAR((*at)[0], 100 * 0.5735625 + 10, 1e-12);
  EXPECT_NEAR((*at)[1], 200 * -1.137125 + 20, 1e-12);
}

TEST(CameraProject, ShowsNothingBehindTheCameraOrBeyondTheFoldOfTheDistortion) {
  Camera camera;
  camera.fx = camera.fy = 100;
  double z = 1;
  EXPECT_FALSE(camera.project({0, 0, -1}, &z));
  EXPECT_EQ(z, -1);
  EXPECT_FALSE(camera.project({0, 0, 0}));
  camera.distortion = {-1.0 / 3, 0, 0, 0};  // r - r^3 / 3 turns back at r = 1
  EXPECT_TRUE(camera.project({0.99, 0, 1}));
  EXPECT_FALSE(camera.project({1.01, 0, 1}));
  EXPECT_FALSE(camera.project({1.7, 0, 1}));  // would be folded onto 0.06
  camera.distortion = {-1.0, 1.0, 0, 0};      // 1 - 3 s + 5 s^2 has no root: it never turns back
  EXPECT_TRUE(camera.project({3, 0, 1}));
}

// -- Formats in detail -------------------------------------------------------------------------

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

TEST(Splits, WithoutNamesEveryFourthIsHeldOut) {
  Capture capture;
  capture.cameras.resize(9);
  EXPECT_THAT(*split_cameras(capture, ""), ElementsAre(0, 1, 2, 4, 5, 6, 8));
  EXPECT_THAT(*split_cameras(capture, "evaluation"), ElementsAre(3, 7));
  capture.splits["evaluation"] = {0, 1};
  EXPECT_THAT(*split_cameras(capture, ""), ElementsAre(2, 3, 4, 5, 6, 7, 8));
}

TEST(Splits, OneOfNIsEveryNthOfWhatIsNotHeldOut) {
  Capture capture;
  capture.cameras.resize(9);
  EXPECT_THAT(*split_cameras(capture, "1/1"), ElementsAre(0, 1, 2, 4, 5, 6, 8));
  EXPECT_THAT(*split_cameras(capture, "1/3"), ElementsAre(0, 4, 8));
  capture.splits["evaluation"] = {0, 1};
  capture.splits["dense"] = {2};
  EXPECT_THAT(*split_cameras(capture, "1/2"), ElementsAre(2, 4, 6, 8));
  for (const char* wrong : {"1/0", "1/", "1/-2", "1/2x", "2/3", "1/99999"})
    EXPECT_FALSE(split_cameras(capture, wrong)) << wrong;
}

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

TEST(Colmap, PointsOfTheModelAreTheCloudUnlessThereIsAPly) {
  for (const auto& write :
       {std::function<void(const fs::path&)>(write_colmap_binary),
        std::function<void(const fs::path&)>([](const fs::path& p) { write_colmap_text(p); })}) {
    const TemporaryDirectory directory;
    write(directory.path());
    auto capture = load_capture(directory / "sparse/0");
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_THAT(capture->cloud.positions,
                ElementsAre(std::array<float, 3>{0, 0, 0}, std::array<float, 3>{0.125f, 0.25f, 0}));
    EXPECT_EQ(capture->cloud.colours[0], (std::array<std::uint8_t, 3>{10, 20, 30}));
    EXPECT_THAT(capture->warnings, ElementsAre(HasSubstr("no normals")));
    EXPECT_EQ(capture->image_files[0], directory / "images/a.png");
    write_points(directory / "points.ply");
    capture = load_capture(directory.path());
    ASSERT_TRUE(capture) << capture.error().message;
    EXPECT_EQ(capture->cloud.positions.size(), 3u);
    CaptureOptions other;
    other.points = directory / "other.ply";
    PointCloud cloud;
    cloud.positions = {{0, 0, 0}};
    ASSERT_TRUE(write_ply(other.points, cloud));
    EXPECT_EQ(load_capture(directory.path(), other)->cloud.positions.size(), 1u);
  }
}

TEST(Colmap, ParametersOfEveryModelArePutWhereTheyBelong) {
  const auto camera = [](const std::string& line) {
    const auto capture =
        load_with([&](const fs::path& p) { write_colmap_text(p, "7 " + line + "\n"); });
    EXPECT_TRUE(capture) << capture.error().message;
    return capture ? capture->cameras[0] : Camera{};
  };
  const auto intrinsics = [](const Camera& c) { return std::array{c.fx, c.fy, c.cx, c.cy}; };
  const Camera simple = camera("SIMPLE_PINHOLE 16 12 31 8 6");
  EXPECT_THAT(intrinsics(simple), ElementsAre(31, 31, 8, 6));
  const Camera radial1 = camera("SIMPLE_RADIAL 16 12 31 8 6 0.1");
  EXPECT_THAT(intrinsics(radial1), ElementsAre(31, 31, 8, 6));
  EXPECT_THAT(radial1.distortion, ElementsAre(0.1, 0, 0, 0));
  const Camera radial2 = camera("RADIAL 16 12 31 8 6 0.1 -0.2");
  EXPECT_THAT(intrinsics(radial2), ElementsAre(31, 31, 8, 6));
  EXPECT_THAT(radial2.distortion, ElementsAre(0.1, -0.2, 0, 0));
  const Camera opencv = camera("OPENCV 16 12 31 32 8 6 0.1 -0.2 0.01 0.02");
  EXPECT_THAT(intrinsics(opencv), ElementsAre(31, 32, 8, 6));
  EXPECT_THAT(opencv.distortion, ElementsAre(0.1, -0.2, 0.01, 0.02));
}

TEST(Colmap, AQuaternionOfAnotherLengthIsNormalisedWithAWarning) {
  const auto capture = load_with([](const fs::path& p) {
    write_colmap_text(p, kCamerasTxt, replaced(kImagesTxt, "12 1 0 0 0", "12 2 0 0 0"));
  });
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->cameras[1].rotation[0][0], 1);
  EXPECT_THAT(capture->warnings,
              testing::Contains(HasSubstr("1 rotations are not of unit length")));
}

class ColmapFile : public testing::TestWithParam<const char*> {};

TEST_P(ColmapFile, EveryTruncationAndFlippedByteOfABinaryEndsInACaptureOrAnError) {
  const TemporaryDirectory directory;
  write_colmap_binary(directory.path());
  const fs::path file = directory / "sparse/0" / GetParam();
  const std::string whole = test::read_text(file);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    write_text(file, whole.substr(0, size));
    const auto capture = load_capture(directory.path());
    ASSERT_FALSE(capture) << size << " of " << whole.size() << " bytes";
    EXPECT_EQ(capture.error().code, Errc::kInvalidInput);
    EXPECT_THAT(capture.error().message, HasSubstr(GetParam()));
  }
  for (std::size_t i = 0; i < whole.size(); ++i) {
    std::string changed = whole;
    changed[i] = static_cast<char>(~changed[i]);
    write_text(file, changed);
    const auto capture = load_capture(directory.path());
    if (!capture) {
      EXPECT_FALSE(capture.error().message.empty());
    }
  }
  write_text(file, whole + "x");
  EXPECT_FALSE(load_capture(directory.path()));
}
INSTANTIATE_TEST_SUITE_P(Files, ColmapFile,
                         testing::Values("cameras.bin", "images.bin", "points3D.bin"),
                         [](const auto& file) { return std::string(file.param).substr(0, 6); });

// -- Other entries -----------------------------------------------------------------------------

TEST(Colmap, PointsFarFromZeroAndTheirCamerasAreGivenFromAnOriginNearby) {
  const TemporaryDirectory directory;
  // The set-up about (400000, 5700000, 100): t - R (400000, 5700000, 100).
  write_colmap_text(directory.path(), kCamerasTxt,
                    "12 1 0 0 0 -400000 -5700000 -96 7 b.png\n\n"
                    "5 0.5 0.1 -0.7 0.5 3840060.1 -2879920.2 3100003 7 a.png\n\n");
  write_text(directory / "sparse/0/points3D.txt",
             "9 400000.001 5700000 100 10 20 30 0.5\n8 400000.125 5700000.25 100 1 2 3 0.1\n");
  const auto capture = load_capture(directory.path());
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_EQ(capture->origin, (Vec3{400000, 5700000, 100}));
  EXPECT_EQ(capture->cloud.origin, (Vec3{0, 0, 0}));
  EXPECT_EQ(capture->cloud.positions[1], (std::array<float, 3>{0.125f, 0.25f, 0}));
  EXPECT_NEAR(capture->cloud.positions[0][0], 0.001, 1e-9);
  const Camera& a = capture->cameras[0];
  const auto at = a.project({0, 0, 0});
  ASSERT_TRUE(at);
  EXPECT_NEAR((*at)[0], 9.5, 1e-6);
  EXPECT_NEAR((*at)[1], 2.5, 1e-6);
  EXPECT_NEAR(moved(a, capture->origin).centre()[1], 5700001.96, 1e-6);
  EXPECT_THAT(capture->warnings, ElementsAre(HasSubstr("no normals")));
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
}  // namespace slf
