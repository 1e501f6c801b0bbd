// SPDX-License-Identifier: Apache-2.0
// What people give slf encode and slf eval beside a sound capture: masks that show nothing, meshes,
// clouds in another world.
#include "cli_support.h"
#include "slf/capture.h"

namespace slf::cli_inputs_test {
namespace {

class InputsCli : public TinyCaptureTest {
 protected:
  /// All photographs of the capture get a mask; `shows` says which have the object.
  template <class Shows>
  void mask(const Shows& shows) {
    auto json = parsed(read("tiny/cameras.json"));
    for (const bool white : {false, true}) {
      const Image image{48, 48, 3, std::vector<std::uint8_t>(48 * 48 * 3, white ? 255 : 0)};
      ASSERT_TRUE(write_png(path(white ? "tiny/white.png" : "tiny/black.png"), image));
    }
    std::vector<std::string> held_out = json["splits"]["evaluation"];
    for (auto& camera : json["cameras"]) {
      const std::string name = camera["image"];
      const bool is_held_out = std::find(held_out.begin(), held_out.end(), name) != held_out.end();
      camera["mask"] = shows(name, is_held_out) ? "white.png" : "black.png";
    }
    write("tiny/cameras.json", json.dump());
  }

  Ran encode(const std::string& more = "") const {
    return slf("encode tiny -o a.slf --grid-bits 5 --effort 1 --surface given -q 16 " + more);
  }
};

bool says(const Ran& ran, const std::string& what) {
  return ran.err.find(what) != std::string::npos;
}

TEST_F(InputsCli, HeldOutPhotographsWithoutTheObjectAreLeftOutWithALine) {
  mask([](const std::string&, bool held_out) { return !held_out; });
  ASSERT_EQ(encode("--quiet").code, 0);
  const Ran ran = slf("eval a.slf tiny --json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(says(ran, "held-out photographs have a mask or alpha without a pixel")) << ran.err;
  const auto report = parsed(ran.out);
  EXPECT_FALSE(report.contains("held_out"));
  EXPECT_GT(report["input"]["image"]["psnr"], 10);
}

TEST_F(InputsCli, InputPhotographsWithoutTheObjectAreLeftOutWithALine) {
  const auto first = parsed(read("tiny/cameras.json"))["splits"]["dense"][0].get<std::string>();
  mask([&](const std::string& name, bool) { return name != first; });
  const Ran ran = encode("--json");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_TRUE(says(ran, "1 of 20 input photographs have a mask or alpha without")) << ran.err;
  EXPECT_TRUE(says(ran, first)) << ran.err;
  EXPECT_EQ(parsed(ran.out)["cameras"], 19);
}

TEST_F(InputsCli, MasksThatAreAllBlackAreNamedWithTheirNumberAndARemedy) {
  mask([](const std::string&, bool) { return false; });
  const Ran ran = encode();
  EXPECT_EQ(ran.code, 4);
  EXPECT_TRUE(says(ran, "the masks (or alpha) of all 20 input photographs are black")) << ran.err;
  EXPECT_TRUE(says(ran, "invert them")) << ran.err;
  EXPECT_FALSE(exists("a.slf"));
}

TEST_F(InputsCli, TinyPhotographsAndOneAloneRaiseNoAlarmOfPoses) {
  for (const char* size : {"64x64", "100x100"}) {
    ASSERT_EQ(slf("synth die -o small --points 1200 --circles 3 --per-circle 8 --size " +
                  std::string(size))
                  .code,
              0);
    const Ran ran = slf("encode small -o s.slf --effort 1 --surface given -q 64");
    ASSERT_EQ(ran.code, 0) << ran.err;
    EXPECT_FALSE(says(ran, "off their photographs")) << size << ": " << ran.err;
  }
  auto json = parsed(read("tiny/cameras.json"));
  json["splits"]["one"] = {json["cameras"][0]["image"]};
  write("tiny/cameras.json", json.dump());
  const Ran one = encode("--split one");
  EXPECT_FALSE(says(one, "off their photographs")) << one.err;
}

TEST_F(InputsCli, AMeshAloneIsToldThatItNeedsPhotographs) {
  write("m.stl", "solid m\nendsolid m\n");
  expect_failure(slf("encode m.stl -o m.slf"), 4, "m.stl", "slf encode CAPTURE --points m.stl");
  for (const char* name : {"STL", "glTF", "OBJ"})
    EXPECT_NE(slf("encode --help").out.find(name), std::string::npos) << name;
}

TEST_F(InputsCli, ACloudThatIsNamedAndMissingIsNotReplacedByAnother) {
  auto json = parsed(read("tiny/cameras.json"));
  json["points"] = "nope.ply";
  write("tiny/cameras.json", json.dump());
  for (const char* beside : {"points.ply", "none"}) {
    expect_failure(encode(), 3, "nope.ply", "cameras.json: points");
    EXPECT_EQ(encode("--quiet --points '" + path("p.ply").string() + "'").code, 3) << beside;
    if (exists("tiny/points.ply")) std::filesystem::rename(path("tiny/points.ply"), path("q.ply"));
  }
  EXPECT_EQ(encode("--quiet --points q.ply").code, 0) << "another is named";
}

TEST_F(InputsCli, WhatIsForPhotographsIsRefusedOfACloudAlone) {
  for (const char* option : {"--splats 300", "--surface-seconds 3", "--photograph-pixels 1",
                             "--match-exposure on", "--images tiny/images"}) {
    const std::string name = std::string(option).substr(0, std::string(option).find(' '));
    expect_failure(slf("encode tiny/points.ply -o a.slf " + std::string(option)), 2, name,
                   "for photographs");
  }
  expect_failure(slf("plan tiny --splats 300 --work w -o p.json"), 2, "--splats", "at once");
  expect_failure(slf("encode tiny -o a.slf --effort 1 --splats 300"), 2, "--splats",
                 "--effort 1 to 3 takes points as they are given");
}

TEST_F(InputsCli, StandardInputIsOneOfThem) {
  for (const char* both : {"encode - --points -", "encode /dev/stdin --points /dev/stdin"})
    expect_failure(slf(std::string(both) + " -o x.slf"), 2, "CAPTURE and --points",
                   "standard input");
}

TEST_F(InputsCli, WhatNoPictureCanShowIsNotCoded) {
  for (const double scale : {1e13, 1e30, 1e-30}) {
    PointCloud cloud;
    for (int i = 0; i < 200; ++i) {
      const auto at = [&](int n) { return static_cast<float>(scale * (i * n % 97)); };
      cloud.positions.push_back({at(7), at(31), at(53)});
      cloud.colours.push_back({9, 90, 200});
    }
    ASSERT_TRUE(write_ply(path("c.ply"), cloud));
    for (const char* options : {"", " --effort 1", " --memory 256M"})
      expect_failure(slf("encode c.ply -o x.slf --quiet" + std::string(options)), 4, "c.ply",
                     scale > 1 ? "within 1e12 of 0" : "no picture");
    EXPECT_FALSE(exists("x.slf"));
  }
}

TEST_F(InputsCli, AGltfBesideTheCamerasIsFoundAsAGlbIs) {
  std::filesystem::remove(path("tiny/points.ply"));
  write("tiny/mesh.gltf", "{");
  expect_failure(slf("encode tiny -o a.slf"), 4, "mesh.gltf", "");
}

TEST_F(InputsCli, PointsAreBroughtIntoTheWorldOfTheCameras) {
  auto cloud = read_ply(path("tiny/points.ply"));
  ASSERT_TRUE(cloud);
  PointCloud turned = *cloud;
  for (std::size_t i = 0; i < cloud->positions.size(); ++i) {
    const auto& p = cloud->positions[i];
    const auto& n = cloud->normals[i];
    turned.positions[i] = {1000 * p[0], 1000 * p[2], -1000 * p[1]};
    turned.normals[i] = {n[0], n[2], -n[1]};
  }
  ASSERT_TRUE(write_ply(path("turned.ply"), turned));
  ASSERT_EQ(encode("--quiet").code, 0);
  const auto as_it_was = parsed(slf("eval a.slf tiny --json").out)["held_out"]["image"]["psnr"];
  ASSERT_EQ(encode("--quiet --points turned.ply --points-world x,-z,y,0.001").code, 0);
  const auto as_it_is = parsed(slf("eval a.slf tiny --json").out)["held_out"]["image"]["psnr"];
  EXPECT_NEAR(as_it_is.get<double>(), as_it_was.get<double>(), 0.5);
  expect_failure(slf("encode tiny -o b.slf --points-world x,x,z"), 2, "--points-world", "x,-z,y");
  expect_failure(slf("encode tiny -o b.slf --points-world x,y,z,0"), 2, "--points-world", "axes");
}

}  // namespace
}  // namespace slf::cli_inputs_test
