// SPDX-License-Identifier: Apache-2.0
// What people have that is no capture: named, with the way to one.
#include <gmock/gmock.h>

#include "capture_formats.h"
#include "slf/gaussian_files.h"
#include "tests/lightfield/gaussian_support.h"

namespace slf::foreign_captures_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

std::string refusal(const std::string& name, const std::string& content) {
  return message_of(load_with([&](const fs::path& p) { write_text(p / name, content); }, name));
}

TEST(ForeignCaptures, FilesAreNamedWithTheWayToACapture) {
  EXPECT_THAT(refusal("bundle.txt", "# Bundle file v0.3\n0 0\n"),
              AllOf(HasSubstr("bundle.txt"), HasSubstr("Bundler"), HasSubstr("list.txt")));
  EXPECT_THAT(refusal("a.psx", "x"), AllOf(HasSubstr("Metashape"), HasSubstr("cameras.xml")));
  EXPECT_THAT(refusal("a.rsproj", "x"), AllOf(HasSubstr("RealityScan"), HasSubstr("COLMAP")));
  EXPECT_THAT(refusal("a.splat", "x"), HasSubstr("by its content no file of Gaussian splats"));
  const auto splats = gaussian_file(random_gaussians(5, 0), SplatFormat::kSpz3);
  EXPECT_THAT(refusal("b.spz", {splats->begin(), splats->end()}), HasSubstr("by themselves"));
  EXPECT_THAT(refusal("a.pcd", "x"), HasSubstr("PLY"));
  EXPECT_THAT(refusal("a.mp4", "x"), HasSubstr("ffmpeg"));
  EXPECT_THAT(refusal("a.json", "{}"), HasSubstr("neither 'cameras' nor 'frames'"));
  EXPECT_THAT(refusal("a.unknown", std::string(5000, '\0')), HasSubstr("that is understood"));
  EXPECT_THAT(refusal("a.unknown", ""), HasSubstr("a.unknown: is empty"));
}

TEST(ForeignCaptures, AMeshAloneIsToldWhereItGoes) {
  for (const char* name : {"m.stl", "m.obj", "m.glb", "m.gltf"})
    EXPECT_THAT(refusal(name, "solid x\n"),
                AllOf(HasSubstr("a mesh needs photographs"),
                      HasSubstr(std::string("slf encode CAPTURE --points ") + name)));
}

TEST(ForeignCaptures, PhotographsOfOtherFormatsAreToBeConverted) {
  EXPECT_THAT(refusal("a.heic", "x"), HasSubstr("convert to PNG or JPEG"));
  EXPECT_THAT(message_of(load_with([](const fs::path& p) { write_text(p / "a.tif", "x"); })),
              AllOf(HasSubstr("1 photographs without cameras"), HasSubstr("convert them")));
}

TEST(ForeignCaptures, WhatIsCodedEmptyOrTextIsSaidToBe) {
  EXPECT_THAT(refusal("a.slf", "\x8BSLF\r\n"), HasSubstr("coded already"));
  EXPECT_THAT(refusal("a.spz", ""), AllOf(HasSubstr("is empty"), Not(HasSubstr("splats"))));
  for (const char* name : {"s.xyz", "s.pts", "s.txt", "s.csv", "s.asc"})
    EXPECT_THAT(refusal(name, "1 2 3 255 0 0\n"), HasSubstr("PLY")) << name;
}

TEST(ForeignCaptures, AFolderOfPhotographsIsToldHowToBeCalibrated) {
  for (const char* folder : {".", "images"})
    EXPECT_THAT(message_of(load_with([&](const fs::path& p) { write_images(p / folder); })),
                AllOf(HasSubstr("not a capture"), HasSubstr("2 photographs without cameras"),
                      HasSubstr("colmap automatic_reconstructor")));
  EXPECT_THAT(
      message_of(load_with([](const fs::path& p) { write_images(p / "keyframes/images"); })),
      HasSubstr("Polycam"));
  EXPECT_THAT(message_of(load_with([](const fs::path& p) { write_text(p / "a.txt", ""); })),
              HasSubstr("not a capture: no cameras.json, COLMAP model or transforms.json"));
}

}  // namespace
}  // namespace slf::foreign_captures_test
