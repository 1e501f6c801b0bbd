// SPDX-License-Identifier: Apache-2.0
// One set-up of two photographs, written as a capture of every format.
#pragma once

#include <functional>

#include "capture_support.h"

namespace slf::test {

namespace fs = std::filesystem;

// The set-up, worked out by hand. Camera a: quaternion (0.5, 0.1, -0.7, 0.5), so
//   R = [-0.48 -0.64 -0.6; 0.36 0.48 -0.8; 0.8 -0.6 0], t = (0.1, -0.2, 3), centre (-2.28, 1.96,
//   -0.1).
// fx 30, fy 60, principal point (8.5, 6.5), image 16 x 12. The world's origin is at t before it, so
// it falls on (30 * 0.1 / 3 + 8.5, 60 * -0.2 / 3 + 6.5) = (9.5, 2.5): the middle of pixel (9, 2).
// Camera b: no rotation, t = (0, 0, 4), the same intrinsics.
inline constexpr int kWidth = 16, kHeight = 12;

inline Image photograph(int channels = 3) {
  Image image{kWidth, kHeight, channels, {}};
  image.data.assign(static_cast<std::size_t>(kWidth * kHeight * channels), 20);
  const std::size_t pixel = static_cast<std::size_t>((2 * kWidth + 9) * channels);
  image.data[pixel] = 250;  // where camera a sees the origin
  return image;
}

inline void write_images(const fs::path& directory) {
  fs::create_directories(directory);
  ASSERT_TRUE(write_png(directory / "a.png", photograph()));
  ASSERT_TRUE(write_png(directory / "b.png", photograph()));
}

inline void write_points(const fs::path& file) {
  PointCloud cloud;
  cloud.positions = {{0, 0, 0}, {0.125f, 0.25f, 0}, {0, 0.125f, 0.25f}};
  cloud.normals = {{-1, 0, 0}, {0, 0, -1}, {0, 0, -1}};
  ASSERT_TRUE(write_ply(file, cloud));
}

inline const std::string kCamerasJson = R"({"unknown": [1, {"x": null}], "cameras": [
  {"image": "images/a.png", "width": 16, "height": 12, "K": [[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],
   "R": [[-0.48, -0.64, -0.6], [0.36, 0.48, -0.8], [0.8, -0.6, 0]], "t": [0.1, -0.2, 3]},
  {"image": "images/b.png", "width": 16, "height": 12, "K": [[30, 0, 8.5], [0, 60, 6.5], [0, 0, 1]],
   "R": [[1, 0, 0], [0, 1, 0], [0, 0, 1]], "t": [0, 0, 4]}],
  "splits": {"dense": ["images/b.png"], "evaluation": ["images/a.png"]}})";

inline void write_shared(const fs::path& root, const std::string& json = kCamerasJson) {
  write_images(root / "images");
  write_points(root / "points.ply");
  write_text(root / "cameras.json", json);
}

// The columns of camera to world are the rows of R, with the second and third negated: right, up,
// backwards. The last is the centre.
inline const std::string kTransformsJson =
    R"({"fl_x": 30, "fl_y": 60, "cx": 8.5, "cy": 6.5, "w": 16, "h": 12,
  "aabb_scale": 4, "frames": [
  {"file_path": "./images/a", "transform_matrix":
   [[-0.48, -0.36, -0.8, -2.28], [-0.64, -0.48, 0.6, 1.96], [-0.6, 0.8, 0, -0.1], [0, 0, 0, 1]]},
  {"file_path": "images/b.png", "transform_matrix":
   [[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, -4], [0, 0, 0, 1]]}]})";

inline void write_transforms(const fs::path& root, const std::string& json = kTransformsJson) {
  write_images(root / "images");
  write_points(root / "points.ply");
  write_text(root / "transforms.json", json);
}

inline const std::string kCamerasTxt = "# Camera list\n\n7 PINHOLE 16 12 30 60 8.5 6.5\n";
// The second line of an image may be empty; the order is COLMAP's, not that of the names.
inline const std::string kImagesTxt =
    "# Image list\n12 1 0 0 0 0 0 4 7 b.png\n\n"
    "5 0.5 0.1 -0.7 0.5 0.1 -0.2 3 7 a.png\n8.5 6.5 -1 1.5 2.5 77\n";
inline const std::string kPointsTxt =
    "# Points\n9 0 0 0 10 20 30 0.5 5 0 12 0\n8 0.125 0.25 0 1 2 3 0.1\n";

inline void write_colmap_text(const fs::path& root, const std::string& cameras = kCamerasTxt,
                              const std::string& images = kImagesTxt) {
  write_images(root / "images");
  write_text(root / "sparse/0/cameras.txt", cameras);
  write_text(root / "sparse/0/images.txt", images);
  write_text(root / "sparse/0/points3D.txt", kPointsTxt);
}

inline std::string cameras_bin() {
  ByteString out;
  out.put(std::uint64_t{1}).put(std::uint32_t{7}).put(std::int32_t{1});
  out.put(std::uint64_t{kWidth}).put(std::uint64_t{kHeight});
  return out.put(30.0).put(60.0).put(8.5).put(6.5).bytes;
}

inline std::string images_bin() {
  ByteString out;
  out.put(std::uint64_t{2});
  out.put(std::uint32_t{12}).put(1.0).put(0.0).put(0.0).put(0.0).put(0.0).put(0.0).put(4.0);
  out.put(std::uint32_t{7}).text("b.png").put('\0').put(std::uint64_t{0});
  out.put(std::uint32_t{5}).put(0.5).put(0.1).put(-0.7).put(0.5).put(0.1).put(-0.2).put(3.0);
  out.put(std::uint32_t{7}).text("a.png").put('\0').put(std::uint64_t{1});
  return out.put(8.5).put(6.5).put(~std::uint64_t{0}).bytes;
}

inline std::string points_bin() {
  ByteString out;
  out.put(std::uint64_t{2});
  out.put(std::uint64_t{9}).put(0.0).put(0.0).put(0.0).text("\x0a\x14\x1e").put(0.5);
  out.put(std::uint64_t{1}).put(std::uint32_t{5}).put(std::uint32_t{0});
  out.put(std::uint64_t{8}).put(0.125).put(0.25).put(0.0).text("\x01\x02\x03").put(0.1);
  return out.put(std::uint64_t{0}).bytes;
}

inline void write_colmap_binary(const fs::path& root) {
  write_images(root / "images");
  write_text(root / "sparse/0/cameras.bin", cameras_bin());
  write_text(root / "sparse/0/images.bin", images_bin());
  write_text(root / "sparse/0/points3D.bin", points_bin());
}

inline Result<Capture, InputError> load_with(const std::function<void(const fs::path&)>& write,
                                             const std::string& path = "") {
  const TemporaryDirectory directory;
  write(directory.path());
  return load_capture(path.empty() ? directory.path() : directory / path);
}

inline std::string message_of(const Result<Capture, InputError>& capture) {
  return capture ? "accepted" : to_string(capture.error().code) + (": " + capture.error().message);
}

}  // namespace slf::test
