// SPDX-License-Identifier: Apache-2.0
// Cameras of Bundler, Metashape and openMVG.
#include <gmock/gmock.h>

#include "other_cameras.h"

namespace slf::other_cameras_test {
namespace {

using namespace test;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Camera a of the set-up, whatever its intrinsics.
void expect_pose_a(const Camera& a) {
  const std::array<Vec3, 3> rotation{{{-0.48, -0.64, -0.6}, {0.36, 0.48, -0.8}, {0.8, -0.6, 0}}};
  const Vec3 translation{0.1, -0.2, 3};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.translation[i], translation[i], 1e-12);
    for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(a.rotation[i][j], rotation[i][j], 1e-12);
  }
}

TEST(Bundler, CamerasArePutIntoOurAxesWithTheirLensAndPoints) {
  for (const char* place : {"bundle.out", "bundle/bundle.out"}) {
    const auto capture = load_with([&](const fs::path& p) { write_bundler(p, place); });
    ASSERT_TRUE(capture) << capture.error().message;
    ASSERT_EQ(capture->cameras.size(), 2u);
    const Camera& a = capture->cameras[0];
    expect_pose_a(a);
    EXPECT_THAT(a.distortion, ElementsAre(-0.1, 0.02, 0, 0));
    EXPECT_THAT((std::array{a.fx, a.fy, a.cx, a.cy}), ElementsAre(30, 30, 8, 6));
    EXPECT_THAT(capture->cloud.colours[1], ElementsAre(1, 2, 3));
    EXPECT_THAT(capture->cloud.positions[1], ElementsAre(0.125f, 0.25f, 0.f));
    EXPECT_THAT(capture->warnings, ::testing::Contains(HasSubstr("1 of 3 cameras have no pose")));
  }
}

// Sizes are those of the photographs, so the importer itself has to look where they are.
TEST(Bundler, PhotographsAndTheirListMayBeInAFolderThatIsNamed) {
  const std::string names = "a.png\nc.png 0 30\nsub/b.png 0 30\n";
  const std::vector<std::array<const char*, 2>> kPlaces = {
      {"cameras/bundle.out", "photographs/list.txt"},
      {"cameras/bundle.out", "cameras/list.txt"},
      {"cameras/model.bundle.out", "cameras/model.list.txt"}};  // as COLMAP writes them
  for (const auto& [cameras, list] : kPlaces) {
    const TemporaryDirectory directory;
    for (const char* folder : {"cameras", "photographs"})
      fs::create_directories(directory / folder);
    write_images(directory / "photographs");
    write_text(directory / cameras, kBundleOut);
    write_text(directory / list, names);
    const auto missing = load_capture(directory / cameras);
    EXPECT_THAT(message_of(missing), HasSubstr("cameras/"));
    CaptureOptions options;
    options.images = directory / "photographs";
    const auto capture = load_capture(directory / cameras, options);
    ASSERT_TRUE(capture) << capture.error().message;
    ASSERT_EQ(capture->image_files.size(), 2u);
    EXPECT_EQ(capture->image_files[1], directory / "photographs/b.png");
    EXPECT_EQ(capture->cameras[1].width, kWidth);
  }
}

std::string bundler_refusal(const std::string& from, const std::string& to) {
  return message_of(load_with(
      [&](const fs::path& p) { write_bundler(p, "bundle.out", replaced(kBundleOut, from, to)); }));
}

TEST(Bundler, WhatIsWrongIsNamedWithItsCamera) {
  EXPECT_THAT(bundler_refusal("3 2\n", "4000000000 2\n"), HasSubstr("do not fit in the file"));
  EXPECT_THAT(bundler_refusal("3 2\n", "3 4000000000\n"), HasSubstr("do not fit in the file"));
  EXPECT_THAT(bundler_refusal("30 0 0", "30 0 x"), HasSubstr("camera 2: f k1 k2"));
  EXPECT_THAT(bundler_refusal("30 0 0", "30 0 inf"), HasSubstr("camera 2: f k1 k2 is not finite"));
  EXPECT_THAT(bundler_refusal("30 0 0", "-30 0 0"), HasSubstr("camera 2: the focal length"));
  EXPECT_THAT(bundler_refusal("10 20 30", "10 20 300"), HasSubstr("point 0: colour"));
  EXPECT_THAT(bundler_refusal("1 0 5 0.5 0.5", "4000000000 0 5"), HasSubstr("point 0: view"));
  EXPECT_THAT(bundler_refusal("3 2\n", "2 2\n"), HasSubstr("point"));
  EXPECT_THAT(message_of(load_with([](const fs::path& p) {
                write_bundler(p, "bundle.out");
                write_text(p / "list.txt", "images/a.png\n");
              })),
              AllOf(HasSubstr("3 cameras"), HasSubstr("list.txt has 1 photographs")));
  EXPECT_THAT(
      message_of(load_with([](const fs::path& p) { write_text(p / "bundle.out", kBundleOut); })),
      HasSubstr("list.txt, a photograph a line, is missing"));
}

TEST(Metashape, ComponentsAndGroupsAndLeftOutCamerasAreTakenAsTheyAre) {
  const auto capture = load_with([](const fs::path& p) { write_metashape(p); });
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->cameras.size(), 2u);
  expect_pose_a(capture->cameras[0]);
  EXPECT_THAT(capture->warnings, ElementsAre(HasSubstr("1 of 3 cameras have no pose")));
}

std::string metashape_refusal(const std::string& from, const std::string& to) {
  return message_of(
      load_with([&](const fs::path& p) { write_metashape(p, replaced(kMetashapeXml, from, to)); }));
}

TEST(Metashape, ItsTangentialTermsAreThoseOfOpenCvTheOtherWayRound) {
  const auto capture = load_with([](const fs::path& p) {
    write_metashape(p, replaced(kMetashapeXml, "<b1>", "<p1>0.01</p1><p2>0.02</p2><b1>"));
  });
  ASSERT_TRUE(capture) << capture.error().message;
  EXPECT_THAT(capture->cameras[0].distortion, ElementsAre(0, 0, 0.02, 0.01));
}

TEST(Metashape, AFileOfManySmallElementsIsRefusedBeforeItTakesItsMemory) {
  std::string elements;
  for (int i = 0; i < (1 << 20) + 100; ++i) elements += "<a/>";
  const auto capture = load_with([&](const fs::path& p) {
    write_metashape(p, replaced(kMetashapeXml, "<chunk ", elements + "<chunk "));
  });
  ASSERT_FALSE(capture);
  EXPECT_THAT(capture.error().message, HasSubstr("more than 1,048,576 elements"));
}

TEST(Metashape, WhatIsNotReadIsNamedWithItsLine) {
  EXPECT_THAT(metashape_refusal("type=\"frame\"", "type=\"fisheye\""),
              AllOf(HasSubstr("line 6"), HasSubstr("fisheye")));
  EXPECT_THAT(metashape_refusal("<b1>", "<b2>9</b2><b1>"), HasSubstr("skew"));
  EXPECT_THAT(metashape_refusal("<f>60</f>", ""), HasSubstr("no f above 0"));
  EXPECT_THAT(metashape_refusal("<f>60</f>", "<f>6x</f>"), HasSubstr("no number"));
  EXPECT_THAT(metashape_refusal("<scale>2</scale>", "<scale>0</scale>"), HasSubstr("scale"));
  EXPECT_THAT(
      metashape_refusal("width=\"16\" height=\"12\"/>\n          <f>", "width=\"99999\"/>\n<f>"),
      HasSubstr("65535"));
  EXPECT_THAT(metashape_refusal("sensor_id=\"0\" component", "sensor_id=\"7\" component"),
              HasSubstr("no such sensor"));
  EXPECT_THAT(metashape_refusal("0 0 0 1</transform>", "0 0 1</transform>"),
              HasSubstr("16 numbers"));
  EXPECT_THAT(metashape_refusal("</document>", ""), HasSubstr("does not end"));
  EXPECT_THAT(metashape_refusal("<document", "<!DOCTYPE x><document"), HasSubstr("document types"));
  EXPECT_THAT(metashape_refusal("label=\"a\"", "label=\"&a;\""), HasSubstr("entity"));
  EXPECT_THAT(metashape_refusal("label=\"a\"", "label=\"..\""), HasSubstr("leads out"));
}

TEST(OpenMvg, ViewsFindTheirLensAndTheirPose) {
  const auto capture = load_with([](const fs::path& p) { write_openmvg(p); });
  ASSERT_TRUE(capture) << capture.error().message;
  ASSERT_EQ(capture->cameras.size(), 2u);
  const Camera& a = capture->cameras[0];
  EXPECT_EQ(a.name, "a.png");
  expect_pose_a(a);
  EXPECT_THAT((std::array{a.fx, a.fy, a.cx, a.cy}), ElementsAre(30, 30, 8.5, 6.5));
  EXPECT_THAT(a.distortion, ElementsAre(-0.1, 0.02, 0, 0));
  EXPECT_THAT(capture->cameras[1].distortion, ElementsAre(0.1, 0, 0.01, 0.02));
  EXPECT_EQ(capture->cloud.positions.size(), 2u);
  EXPECT_THAT(capture->warnings, ::testing::Contains(HasSubstr("1 of 3 cameras have no pose")));
}

std::string openmvg_refusal(const std::string& from, const std::string& to) {
  return message_of(
      load_with([&](const fs::path& p) { write_openmvg(p, replaced(kSfmData, from, to)); }));
}

TEST(OpenMvg, WhatIsNotReadIsNamedWithItsPlace) {
  EXPECT_THAT(openmvg_refusal("disto_k3", "fisheye"), HasSubstr("fisheye cameras"));
  EXPECT_THAT(openmvg_refusal("[-0.1, 0.02, 0]", "[-0.1, 0.02]"),
              HasSubstr("intrinsics[0].value.ptr_wrapper.data.disto_k3"));
  EXPECT_THAT(openmvg_refusal("\"focal_length\": 30,", ""), HasSubstr("no pinholes"));
  EXPECT_THAT(openmvg_refusal("\"key\": 7", "\"key\": 3"), HasSubstr("twice"));
  EXPECT_THAT(openmvg_refusal("\"id_pose\": 7", "\"id_pose\": -1"), HasSubstr("an id of"));
  EXPECT_THAT(openmvg_refusal("\"extrinsics\"", "\"poses\""),
              AllOf(HasSubstr("(openMVG)"), HasSubstr("extrinsics")));
}

// A lens of Metashape has k3: what k1 and k2 miss of it is below what is seen, or refused.
TEST(RadialTerms, TermsOfHigherOrderAreExpressedOrRefused) {
  Camera camera;
  camera.width = 6000;
  camera.height = 4000;
  camera.fx = camera.fy = 5000;
  camera.cx = 3000;
  camera.cy = 2000;
  Camera near = camera;
  const RadialTerms lens{-0.05, 0.03, -0.02, 0};
  const auto miss = set_radial(lens, near);
  ASSERT_TRUE(miss);
  EXPECT_NEAR(*miss, 0.556, 0.01);          // by least squares in numpy
  for (const double x : {0.1, 0.3, 0.6}) {  // towards an edge
    const double s = x * x, bent = x * (1 + s * (lens[0] + s * (lens[1] + s * lens[2])));
    EXPECT_NEAR((*near.project({x, 0, 1}))[0], 5000 * bent + 3000, *miss + 1e-9);
  }
  Camera refused = camera;
  double worst = 0;
  const auto far = set_radial({0, 0, 4, 0}, "lens 7", refused, worst);
  ASSERT_FALSE(far);
  EXPECT_THAT(far.error().message, AllOf(HasSubstr("lens 7"), HasSubstr("undistorted")));
  EXPECT_FALSE(set_radial({0, 0, -40, 0}, camera));  // it folds before the corner
}

// Every prefix and every changed byte is a capture or an error, under sanitizers.
TEST(OtherCameras, NoByteOfTheirFilesLeadsOutOfThem) {
  const TemporaryDirectory directory;
  write_images(directory / "images");
  write_text(directory / "list.txt", "images/a.png\nimages/b.png\nimages/c.png\n");
  for (const auto& [name, whole] : {std::pair{"bundle.out", kBundleOut},
                                    {"cameras.xml", kMetashapeXml},
                                    {"sfm.json", kSfmData}})
    for (std::size_t at = 0; at < whole.size(); at += 3) {
      write_text(directory / name, whole.substr(0, at));
      EXPECT_FALSE(load_capture(directory / name) && at < 20);
      std::string changed = whole;
      changed[at] = at % 2 == 0 ? '9' : '\xFF';
      write_text(directory / name, changed);
      const auto capture = load_capture(directory / name);
      const std::string message = capture ? name : capture.error().message;
      EXPECT_THAT(message, HasSubstr(capture ? name : directory.path().string()));
    }
}

}  // namespace
}  // namespace slf::other_cameras_test
