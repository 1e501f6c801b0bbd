// SPDX-License-Identifier: Apache-2.0
// What a program makes in memory is checked as files are: nothing is read beyond a vector's end.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "encoder/parts/scene_cameras.h"
#include "encoder/plenoptic/plenoptic_coding.h"
#include "slf/decoder.h"
#include "slf/encode_gaussians.h"
#include "slf/frame_reader.h"
#include "slf/gaussian_files.h"
#include "slf/gaussian_frames.h"
#include "slf/scene.h"
#include "tests/encoder/plenoptic_support.h"

namespace slf::made_in_memory_test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

Gaussians two_splats() {
  Gaussians out;
  out.degree = 1;
  out.positions = {{0, 0, 0}, {1, 0, 0}};
  out.log_deviations = {{-2, -2, -2}, {-2, -2, -2}};
  out.rotations = {{1, 0, 0, 0}, {1, 0, 0, 0}};
  out.logits = {2, 2};
  out.harmonics.assign(24, 0.1f);
  return out;
}

Capture four_points_one_camera() {
  Capture capture;
  capture.cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  capture.cloud.colours.assign(4, {1, 2, 3});
  Camera camera;
  camera.name = "a";
  camera.width = camera.height = 8;
  camera.fx = camera.fy = 8;
  camera.cx = camera.cy = 4;
  camera.translation = {0, 0, 4};
  capture.cameras = {camera};
  capture.images = {Image{8, 8, 3, std::vector<std::uint8_t>(192, 100)}};
  return capture;
}

template <class T>
std::string refusal(const Result<T, InputError>& result) {
  return result ? "" : result.error().message;
}

TEST(MadeInMemory, SplatsWhosePartsDoNotGoTogetherAreRefusedByName) {
  ASSERT_TRUE(check_gaussians(two_splats()));
  const std::vector<std::pair<std::string, std::function<void(Gaussians&)>>> wrong = {
      {"degree", [](Gaussians& g) { g.degree = 5; }},
      {"degree", [](Gaussians& g) { g.degree = -1; }},
      {"log_deviations", [](Gaussians& g) { g.log_deviations.pop_back(); }},
      {"rotations", [](Gaussians& g) { g.rotations.clear(); }},
      {"logits", [](Gaussians& g) { g.logits.pop_back(); }},
      {"harmonics", [](Gaussians& g) { g.harmonics.pop_back(); }},
      {"positions: splat 1", [](Gaussians& g) { g.positions[1][2] = kNan; }},
      {"log_deviations: splat 0", [](Gaussians& g) { g.log_deviations[0][0] = -1 / 0.0f; }},
      {"logits: splat 1", [](Gaussians& g) { g.logits[1] = kNan; }},
      {"harmonics: splat 1", [](Gaussians& g) { g.harmonics[12] = kNan; }},
      {"rotations: that of splat 1",
       [](Gaussians& g) {
         g.rotations[1] = {0, 0, 0, 0};
       }},
      {"rotations: that of splat 1", [](Gaussians& g) {
         g.rotations[1] = {2, 0, 0, 0};
       }}};
  for (const auto& [name, damage] : wrong) {
    Gaussians splats = two_splats();
    damage(splats);
    EXPECT_NE(refusal(encode_gaussians(splats, {})).find(name), std::string::npos) << name;
    EXPECT_NE(refusal(gaussian_file(splats, SplatFormat::kSpz)).find(name), std::string::npos);
    const auto frames = encode_gaussian_frames(
        2,
        [&](std::size_t f) -> Result<Gaussians, InputError> { return f ? splats : two_splats(); },
        {}, {},
        [](std::size_t, std::span<const std::uint8_t>) -> Result<Done, InputError> {
          return Done{};
        });
    EXPECT_NE(refusal(frames).find("frame 1: splats: " + name), std::string::npos)
        << refusal(frames);
  }
}

TEST(MadeInMemory, SettingsOfSplatsOutOfRangeAreRefusedByName) {
  const std::vector<std::pair<std::string, std::function<void(EncoderSettings&)>>> wrong = {
      {"quality", [](EncoderSettings& s) { s.q = -3; }},
      {"quality", [](EncoderSettings& s) { s.q = 1e6; }},
      {"quality", [](EncoderSettings& s) { s.q = double{kNan}; }},
      {"grid-bits", [](EncoderSettings& s) { s.grid_bits = 50; }},
      {"grid-bits", [](EncoderSettings& s) { s.grid_bits = -4; }},
      {"voxel-size", [](EncoderSettings& s) { s.voxel_size = -1; }},
      {"voxel-size", [](EncoderSettings& s) { s.voxel_size = double{kNan}; }},
      {"Draco", [](EncoderSettings& s) { s.geometry = GeometryCoder::kDraco; }},
      {"texture", [](EncoderSettings& s) { s.coefficients = CoefficientCoder::kTexture; }}};
  for (const auto& [name, change] : wrong) {
    EncoderSettings settings;
    change(settings);
    EXPECT_NE(refusal(encode_gaussians(two_splats(), settings)).find(name), std::string::npos)
        << name << ": " << refusal(encode_gaussians(two_splats(), settings));
  }
}

TEST(MadeInMemory, CapturesWhosePartsDoNotGoTogetherAreRefusedByName) {
  const std::vector<int> one = {0};
  ASSERT_EQ(refusal(check_capture(four_points_one_camera(), one)), "");
  const std::vector<std::pair<std::string, std::function<void(Capture&)>>> wrong = {
      {"camera 'a': an image of 192 bytes has 191",
       [](Capture& c) { c.images[0].data.pop_back(); }},
      {"channels", [](Capture& c) { c.images[0].channels = 1; }},
      {"2 images of 1 cameras", [](Capture& c) { c.images.push_back(c.images[0]); }},
      {"0 images of 1 cameras", [](Capture& c) { c.images.clear(); }},
      {"not finite", [](Capture& c) { c.cameras[0].fx = double{kNan}; }},
      {"not orthonormal", [](Capture& c) { c.cameras[0].rotation = {}; }},
      {"colours: 3 of 4", [](Capture& c) { c.cloud.colours.pop_back(); }},
      {"normals: 1 of 4",
       [](Capture& c) {
         c.cloud.normals = {{0, 0, 1}};
       }},
      {"point 2", [](Capture& c) { c.cloud.positions[2][1] = -1 / 0.0f; }},
      {"point 1 has a coordinate of 1999999991808",
       [](Capture& c) {
         c.cloud.positions[1] = {0, 0, 2e12F};
       }},
      {"mesh: point 0 has a coordinate",
       [](Capture& c) {
         c.mesh.vertices.positions = {{1e30F, 0, 0}};
       }},
      {"has a coordinate of -3e+13",
       [](Capture& c) {
         c.origin = {0, -3e13, 0};
       }},
      {"camera 'a' has a coordinate",
       [](Capture& c) {
         c.cameras[0].translation = {0, 0, 1e30};
       }},
      {"gains: 2 of 1", [](Capture& c) { c.gains.resize(2); }},
      {"face 0 has vertex 7 of 0", [](Capture& c) {
         c.mesh.triangles = {{7, 0, 0}};
       }}};
  for (const auto& [name, damage] : wrong) {
    Capture capture = four_points_one_camera();
    damage(capture);
    EXPECT_NE(refusal(encode(capture, one, {})).find(name), std::string::npos)
        << name << ": " << refusal(encode(capture, one, {}));
  }
}

TEST(MadeInMemory, SurfacesThatPhotographsMakeAreRefusedWithoutThese) {
  Capture cloud = four_points_one_camera();
  cloud.cameras.clear();
  cloud.images.clear();
  EncoderSettings settings;
  ASSERT_TRUE(encode(cloud, {}, settings));
  for (const Surface surface : {Surface::kMended, Surface::kTrained, Surface::kSplats}) {
    settings.surface = surface;
    EXPECT_EQ(refusal(encode(cloud, {}, settings)),
              std::string("surface ") + word_of(surface) + ": for photographs, and there are none");
  }
}

TEST(MadeInMemory, CamerasThatTheCaptureDoesNotHaveAreRefused) {
  const Capture capture = four_points_one_camera();
  for (const int camera : {-1, 1, 99999}) {
    const std::vector<int> cameras = {camera};
    const std::string text = "camera " + std::to_string(camera) + ": the capture has 1";
    EXPECT_EQ(refusal(encode(capture, cameras, {})), text);
    SceneWork work;
    work.directory = testing::TempDir();
    EXPECT_EQ(refusal(plan_scene(capture, cameras, {}, {}, work)), text);
    const LoadFrame load = [&](std::size_t) -> Result<LoadedFrame, InputError> {
      return LoadedFrame{capture, cameras};
    };
    EXPECT_EQ(refusal(plan_frames(1, load, {}, {})), "frame 0: " + text);
  }
}

TEST(PlansOfScenes, KnowPhotographsWhereverACaptureIsReadFrom) {
  const Vec3 far = {500000, 4000000, 100};
  Capture whole = four_points_one_camera(), alone = whole;
  whole.origin = far;                               // as it is read with its cloud
  alone.cameras[0] = moved(alone.cameras[0], far);  // and without
  EXPECT_EQ(digest_of_photographs(whole, far), digest_of_photographs(alone, far));
  Capture other = alone;
  other.cameras[0].translation[2] += 0.5;
  EXPECT_NE(digest_of_photographs(other, far), digest_of_photographs(alone, far));
}

TEST(MadeInMemory, PlenopticCloudsNeedNoPropertiesAndAreCheckedElse) {
  PlenopticCloud given = test::sphere_of_views(3);
  given.properties.clear();
  const auto encoded = encode_plenoptic(given, {});
  ASSERT_TRUE(encoded) << encoded.error().message;
  const auto field = decode(encoded->stream);
  ASSERT_TRUE(field);
  const auto back = decode_plenoptic(encoded->stream, *field, read_info(encoded->stream)->metadata);
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(back->colours, given.colours);
  EXPECT_EQ(back->properties.back().name, "blue_2");
  EXPECT_FALSE(decode_plenoptic({}, *field, read_info(encoded->stream)->metadata));

  const std::vector<std::pair<std::string, std::function<void(PlenopticCloud&)>>> wrong = {
      {"0 views", [](PlenopticCloud& c) { c.views = 0; }},
      {"300 views", [](PlenopticCloud& c) { c.views = 300; }},
      {"colours", [](PlenopticCloud& c) { c.colours.pop_back(); }},
      {"view_positions", [](PlenopticCloud& c) { c.view_positions.pop_back(); }},
      {"properties", [](PlenopticCloud& c) { c.properties.resize(4); }}};
  for (const auto& [name, damage] : wrong) {
    PlenopticCloud cloud = test::sphere_of_views(3);
    damage(cloud);
    EXPECT_NE(refusal(encode_plenoptic(cloud, {})).find(name), std::string::npos) << name;
    EXPECT_FALSE(measure_plenoptic(cloud, cloud)) << name;
  }
}

TEST(MadeInMemory, FramesThatAreNotThereHaveNoBytes) {
  std::vector<std::uint8_t> stream;
  const auto made = encode_gaussian_frames(
      1, [](std::size_t) -> Result<Gaussians, InputError> { return two_splats(); }, {}, {},
      [&](std::size_t, std::span<const std::uint8_t> bytes) -> Result<Done, InputError> {
        stream.assign(bytes.begin(), bytes.end());
        return Done{};
      });
  ASSERT_TRUE(made) << made.error().message;
  FrameReader reader = *FrameReader::open();
  ASSERT_TRUE(reader.push(stream));
  ASSERT_TRUE(reader.finish());
  ASSERT_EQ(reader.frames().size(), 1u);
  EXPECT_FALSE(reader.bytes_of(0).empty());
  for (const std::size_t place : {std::size_t{1}, std::size_t{4}, std::size_t(-1)}) {
    EXPECT_TRUE(reader.bytes_of(place).empty());
    EXPECT_EQ(reader.group_of(place), 1u);
  }
  FrameSettings none;
  none.group = 0;
  EXPECT_EQ(frames_of_part(4, none).count, 0u);
  none.group = 16;
  none.parts = 0;
  EXPECT_EQ(frames_of_part(4, none).count, 0u);
}

}  // namespace
}  // namespace slf::made_in_memory_test
