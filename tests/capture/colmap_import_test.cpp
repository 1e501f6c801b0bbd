// SPDX-License-Identifier: Apache-2.0
// Models of COLMAP, as text and as binaries.
#include <gmock/gmock.h>

#include <functional>

#include "capture_formats.h"

namespace slf::colmap_import_test {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

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

TEST(Colmap, ACameraThatNoImageHasMayBeOfAnyModel) {
  constexpr std::array<int, 18> kParameters = {3, 4,  4,  5, 8, 8, 12, 5, 4,
                                               5, 12, 16, 4, 5, 3, 4,  6, 2};
  for (std::int32_t model = 0; model < 18; ++model) {
    const auto capture = load_with([&](const fs::path& p) {
      write_colmap_binary(p);
      ByteString other;  // before the one that images have
      other.put(std::uint64_t{2}).put(std::uint32_t{3}).put(model);
      other.put(std::uint64_t{kWidth}).put(std::uint64_t{kHeight});
      for (int i = 0; i < kParameters[std::size_t(model)]; ++i) other.put(1.5);
      write_text(p / "sparse/0/cameras.bin", other.bytes + cameras_bin().substr(8));
    });
    ASSERT_TRUE(capture) << model << capture.error().message;
    EXPECT_EQ(capture->cameras[0].fx, 30);
  }
  const auto text = load_with([&](const fs::path& p) {
    write_colmap_text(p, "3 OPENCV_FISHEYE 16 12 30 60 8 6 0 0 0 0\n" + kCamerasTxt);
  });
  EXPECT_TRUE(text) << text.error().message;
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

}  // namespace
}  // namespace slf::colmap_import_test
