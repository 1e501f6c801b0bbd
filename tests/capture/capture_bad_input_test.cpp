// SPDX-License-Identifier: Apache-2.0
// Captures that cannot be meant are refused with file and cause; suspicious ones are warned about.
#include <gmock/gmock.h>
#include <sys/stat.h>

#include "capture_formats.h"

namespace slf::capture_bad_input_test {
namespace {

using namespace test;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct Bad {
  const char* name;
  std::function<void(const fs::path&)> write;
  const char* error;  // code and part of the message
};
void PrintTo(const Bad& bad, std::ostream* out) { *out << bad.name; }
class BadCapture : public testing::TestWithParam<Bad> {};

TEST_P(BadCapture, IsRefusedWithFileAndCause) {
  const std::string message = message_of(load_with(GetParam().write));
  const std::string error = GetParam().error;
  const auto colon = error.find(": ");
  EXPECT_THAT(message, testing::StartsWith(error.substr(0, colon + 2)));
  EXPECT_THAT(message, HasSubstr(error.substr(colon + 2)));
}

std::function<void(const fs::path&)> shared(const std::string& from, const std::string& to) {
  return [=](const fs::path& p) { write_shared(p, replaced(kCamerasJson, from, to)); };
}
std::function<void(const fs::path&)> image_b(const std::string& path) {
  return [=](const fs::path& p) {
    const std::string json = replaced(kCamerasJson, "\"dense\": [\"images/b.png\"], ", "");
    write_shared(p, replaced(json, "images/b.png", path));
  };
}
std::function<void(const fs::path&)> transforms(const std::string& from, const std::string& to) {
  return [=](const fs::path& p) { write_transforms(p, replaced(kTransformsJson, from, to)); };
}
std::function<void(const fs::path&)> colmap_cameras(const std::string& line) {
  return [=](const fs::path& p) { write_colmap_text(p, line); };
}
std::function<void(const fs::path&)> colmap_images(const std::string& from, const std::string& to) {
  return
      [=](const fs::path& p) { write_colmap_text(p, kCamerasTxt, replaced(kImagesTxt, from, to)); };
}
void with_cloud_at(const fs::path& root, float x, float y, float z) {
  write_shared(root);
  PointCloud cloud;
  cloud.positions = {{x, y, z}, {x, y, z + 0.1f}};
  ASSERT_TRUE(write_ply(root / "points.ply", cloud));
}

INSTANTIATE_TEST_SUITE_P(
    Files, BadCapture,
    testing::Values(
        Bad{"nothing_there", [](const fs::path& p) { fs::remove(p); }, "kUnreadable: no such file"},
        Bad{"empty_directory", [](const fs::path&) {}, "kInvalidInput: not a capture"},
        Bad{"missing_image",
            [](const fs::path& p) {
              write_shared(p);
              fs::remove(p / "images/b.png");
            },
            "kUnreadable: images/b.png: No such file"},
        Bad{"image_is_no_image",
            [](const fs::path& p) {
              write_shared(p);
              write_text(p / "images/b.png", "text");
            },
            "kInvalidInput: images/b.png: neither PNG, JPEG nor PPM"},
        Bad{"image_is_a_pipe",
            [](const fs::path& p) {
              write_shared(p);
              fs::remove(p / "images/b.png");
              ASSERT_EQ(::mkfifo((p / "images/b.png").c_str(), 0600), 0);
            },
            "kInvalidInput: images/b.png: is not a regular file"},
        Bad{"image_of_another_size",
            [](const fs::path& p) {
              write_shared(p);
              EXPECT_TRUE(
                  write_png(p / "images/b.png", Image{2, 1, 3, std::vector<std::uint8_t>(6)}));
            },
            "kInvalidInput: images/b.png: image of 2 x 1 pixels, calibrated as 16 x 12"},
        Bad{"missing_cloud",
            [](const fs::path& p) {
              write_shared(p);
              fs::remove(p / "points.ply");
            },
            "kUnreadable: points.ply"},
        Bad{"missing_cloud_of_transforms",
            [](const fs::path& p) {
              write_transforms(p);
              fs::remove(p / "points.ply");
            },
            "kUnreadable: points.ply: the capture has no point cloud"},
        Bad{"cloud_outside_every_frustum", [](const fs::path& p) { with_cloud_at(p, 50, 0, 4); },
            "kInvalidInput: points.ply: no point is inside the frustum of any camera"},
        Bad{"cloud_behind_every_camera", [](const fs::path& p) { with_cloud_at(p, -5, 0, -9); },
            "kInvalidInput: points.ply: every point is behind every camera"},
        Bad{"empty_cloud",
            [](const fs::path& p) {
              write_shared(p);
              EXPECT_TRUE(write_ply(p / "points.ply", {}));
            },
            "kInvalidInput: points.ply: no points"},
        Bad{"mask_of_another_size",
            [](const fs::path& p) {
              shared("\"image\": \"images/b.png\"",
                     "\"image\": \"images/b.png\", \"mask\": \"m.png\"")(p);
              EXPECT_TRUE(write_png(p / "m.png", Image{2, 1, 3, std::vector<std::uint8_t>(6)}));
            },
            "kInvalidInput: m.png: image of 2 x 1"}),
    [](const auto& bad) { return bad.param.name; });

INSTANTIATE_TEST_SUITE_P(
    CamerasJson, BadCapture,
    testing::Values(
        Bad{"not_orthonormal", shared("[[1, 0, 0], [0, 1, 0]", "[[1, 0, 0], [0.01, 1, 0]"),
            "kInvalidInput: cameras.json: cameras[1]: the rotation is not orthonormal"},
        Bad{"mirrored", shared("[[1, 0, 0], [0, 1, 0]", "[[1, 0, 0], [0, -1, 0]"),
            "kInvalidInput: cameras[1]: the rotation mirrors (determinant -1): left-handed"},
        Bad{"zero_focal",
            shared("[[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,",
                   "[[0, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,"),
            "kInvalidInput: cameras[1]: the focal length is not positive"},
        Bad{"negative_focal",
            shared("[[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,",
                   "[[30, 0, 8.5], [0, -60, 6.5], [0, 0, 1]],\n   \"R\": [[1,"),
            "kInvalidInput: cameras[1]: the focal length is not positive"},
        Bad{"skew",
            shared("[[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,",
                   "[[30, 2, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,"),
            "kInvalidInput: cameras[1].K: a skewed camera"},
        Bad{"nan", shared("[0, 0, 4]", "[0, NaN, 4]"),
            "kInvalidInput: cameras.json: cameras[1].t[1]: not valid JSON"},
        Bad{"infinite", shared("[0, 0, 4]", "[0, 0, 1e999]"), "kInvalidInput: cameras[1].t[2]"},
        Bad{"wrong_type", shared("[0, 0, 4]", "[0, \"0\", 4]"),
            "kInvalidInput: cameras.json: cameras[1].t[1]: a number is expected, not a string"},
        Bad{"wrong_count", shared("[0, 0, 4]", "[0, 0]"),
            "kInvalidInput: cameras[1].t: 3 items are expected, not 2"},
        Bad{"missing_name", shared("\"t\": [0, 0, 4]", "\"T\": [0, 0, 4]"),
            "kInvalidInput: cameras[1]: 't' is missing"},
        Bad{"duplicate_name", shared("\"t\": [0, 0, 4]", "\"t\": [0, 0, 4], \"t\": [0, 0, 5]"),
            "kInvalidInput: cameras[1]: the name 't' occurs twice"},
        Bad{"truncated_json",
            [](const fs::path& p) { write_shared(p, kCamerasJson.substr(0, 300)); },
            "kInvalidInput: cameras.json: cameras[1].K[0][1]: not valid JSON at byte 301"},
        Bad{"duplicate_image", shared("\"image\": \"images/b.png\"", "\"image\": \"images/a.png\""),
            "kInvalidInput: cameras[1]: image 'images/a.png' twice"},
        Bad{"size_zero",
            shared("\"images/b.png\", \"width\": 16", "\"images/b.png\", \"width\": 0"),
            "kInvalidInput: cameras[1].width: an image has"},
        Bad{"no_cameras", [](const fs::path& p) { write_shared(p, "{\"cameras\": []}"); },
            "kInvalidInput: has no cameras"},
        Bad{"split_of_no_image", shared("[\"images/b.png\"]", "[\"images/c.png\"]"),
            "kInvalidInput: splits.dense[0]: 'images/c.png' is no image"},
        Bad{"path_traversal", image_b("images/../../b.png"),
            "kInvalidInput: cameras[1]: path 'images/../../b.png' leads out of the capture"},
        Bad{"absolute_path", image_b("/etc/passwd"),
            "kInvalidInput: cameras[1]: path '/etc/passwd' leads out"},
        Bad{"link_out_of_the_capture",
            [](const fs::path& p) {
              image_b("elsewhere/passwd")(p);
              fs::create_directory_symlink("/etc", p / "elsewhere");
            },
            "kInvalidInput: cameras[1]: path 'elsewhere/passwd' leads out of the capture through a "
            "link"},
        Bad{"long_name", image_b("../" + std::string(100000, 'n')),
            "kInvalidInput: nnn...' leads out of the capture"},
        Bad{"deep_json", [](const fs::path& p) { write_shared(p, std::string(100000, '[')); },
            "kInvalidInput: nested deeper than 64"}),
    [](const auto& bad) { return bad.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Transforms, BadCapture,
    testing::Values(
        Bad{"fisheye", transforms("\"fl_x\"", "\"camera_model\": \"OPENCV_FISHEYE\", \"fl_x\""),
            "kInvalidInput: camera_model: camera model OPENCV_FISHEYE is not supported: undistort"},
        Bad{"is_fisheye", transforms("\"fl_x\"", "\"is_fisheye\": true, \"fl_x\""),
            "kInvalidInput: fisheye"},
        Bad{"k5", transforms("\"fl_x\"", "\"k5\": 0.1, \"fl_x\""),
            "kInvalidInput: frames[0]: distortion k5"},
        Bad{"k3", transforms("\"fl_x\": 30, \"fl_y\": 60", "\"fl_x\": 8, \"k3\": -40"),
            "kInvalidInput: frames[0]: camera: its lens has radial terms k3 or k4"},
        Bad{"no_focal", transforms("\"fl_x\": 30, \"fl_y\": 60, ", ""),
            "kInvalidInput: frames[0]: no focal length: neither fl_x (pixels)"},
        Bad{"scaled_pose", transforms("[[1, 0, 0, 0]", "[[2, 0, 0, 0]"),
            "kInvalidInput: frames[1]: the rotation"},
        Bad{"opencv_axes_mirror",
            transforms("[0, -1, 0, 0], [0, 0, -1, -4]", "[0, 1, 0, 0], [0, 0, -1, -4]"),
            "kInvalidInput: frames[1]: the rotation mirrors"},
        Bad{"no_matrix", transforms("[0, 0, 0, 1]]}]", "[0, 0, 1, 1]]}]"),
            "kInvalidInput: the last row is not 0 0 0 1"},
        Bad{"missing_image", transforms("images/b.png", "images/c"),
            "kUnreadable: images/c.png: No such file"},
        Bad{"traversal", transforms("images/b.png", "../b.png"),
            "kInvalidInput: leads out of the capture"},
        Bad{"same_image_twice", transforms("images/b.png", "images/a.png"),
            "kInvalidInput: 'images/a.png' twice"}),
    [](const auto& bad) { return bad.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Colmap, BadCapture,
    testing::Values(
        Bad{"fisheye", colmap_cameras("7 OPENCV_FISHEYE 16 12 30 60 8 6 0 0 0 0\n"),
            "kInvalidInput: cameras.txt, line 1: camera model OPENCV_FISHEYE is not supported"},
        Bad{"unknown_model", colmap_cameras("7 PINHOLES 16 12 30 60 8 6\n"),
            "kInvalidInput: unknown camera model 'PINHOLES'"},
        Bad{"too_few_parameters", colmap_cameras("7 PINHOLE 16 12 30 60 8\n"),
            "kInvalidInput: line 1: a camera parameter is missing"},
        Bad{"too_many_parameters", colmap_cameras("7 PINHOLE 16 12 30 60 8 6 0\n"),
            "kInvalidInput: too many parameters"},
        Bad{"focal", colmap_cameras("7 PINHOLE 16 12 0 60 8 6\n"),
            "kInvalidInput: image 'a.png': the focal length"},
        Bad{"not_finite", colmap_cameras("7 PINHOLE 16 12 30 nan 8 6\n"),
            "kInvalidInput: not finite"},
        Bad{"camera_twice", colmap_cameras(kCamerasTxt + kCamerasTxt),
            "kInvalidInput: camera 7 twice"},
        Bad{"size", colmap_cameras("7 PINHOLE 99999999999 12 30 60 8 6\n"),
            "kInvalidInput: camera 7: image size"},
        Bad{"dangling_camera", colmap_images("4 7 b.png", "4 8 b.png"),
            "kInvalidInput: image 'b.png': there is no camera 8"},
        Bad{"zero_quaternion", colmap_images("12 1 0 0 0", "12 0 0 0 0"),
            "kInvalidInput: image 'b.png': rotation of length 0"},
        Bad{"image_twice", colmap_images("b.png", "a.png"), "kInvalidInput: image 'a.png': twice"},
        Bad{"traversal", colmap_images("b.png", "../../b.png"),
            "kInvalidInput: leads out of the capture"},
        Bad{"no_name", colmap_images("4 7 b.png", "4 7"),
            "kInvalidInput: images.txt, line 2: image without a name"}),
    [](const auto& bad) { return bad.param.name; });

TEST(CaptureWarnings, SuspiciousButUsable) {
  const auto warnings = [](const std::function<void(const fs::path&)>& write) {
    const auto capture = load_with(write);
    EXPECT_TRUE(capture) << capture.error().message;
    return capture ? capture->warnings : std::vector<std::string>{};
  };
  EXPECT_THAT(warnings(shared("[[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,",
                              "[[30, 0, 10.5], [0, 60, 6.5], [0, 0, 1]],\n   \"R\": [[1,")),
              ElementsAre(HasSubstr("1 of 2 cameras have a principal point")));
  // Camera b turned round: it looks away.
  EXPECT_THAT(warnings(shared("[[1, 0, 0], [0, 1, 0], [0, 0, 1]], \"t\": [0, 0, 4]",
                              "[[-1, 0, 0], [0, 1, 0], [0, 0, -1]], \"t\": [0, 0, -4]")),
              ElementsAre(HasSubstr("1 of 2 cameras do not see the cloud")));
  EXPECT_THAT(warnings([](const fs::path& p) {
                write_shared(p);
                PointCloud cloud;
                cloud.positions = {{0, 0, 0}, {0, 0.1f, 0}};
                cloud.normals = {{0.6f, 0, 0.8f}, {0.6f, 0, 0.8f}};
                EXPECT_TRUE(write_ply(p / "points.ply", cloud));
              }),
              ElementsAre(HasSubstr("normals point inwards")));
}

}  // namespace
}  // namespace slf::capture_bad_input_test
