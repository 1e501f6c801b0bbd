// SPDX-License-Identifier: Apache-2.0
// Captures hundreds of kilometres from zero: the files, figures and pictures of those near zero.
#include <gmock/gmock.h>

#include <cmath>

#include "cli_support.h"
#include "slf/capture.h"
#include "tools/npy.h"

namespace slf::georeference_test {
namespace {

constexpr Vec3 kFar{400000, 5700000, 100};  // metres on a map; a float there is half a metre off
constexpr double kMillimetre = 1.0 / 1024;

/// near/ is a can whose points lie on whole millimetres; far/ is the same about kFar.
class Georeference : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth can -o near --size 64x64 --points 3000 --circles 3 --per-circle 8").code,
              0);
    auto cloud = read_ply(path("near/points.ply"));
    ASSERT_TRUE(cloud) << cloud.error().message;
    cloud->colours.clear();
    for (auto& p : cloud->positions) {
      for (float& x : p) x = static_cast<float>(std::round(double{x} / kMillimetre) * kMillimetre);
      cloud->colours.push_back({static_cast<std::uint8_t>(cloud->colours.size()), 128, 7});
    }
    ASSERT_TRUE(write_ply(path("near/points.ply"), *cloud));
    ASSERT_EQ(shell("cp -r near far").code, 0);
    cloud->origin = kFar;
    ASSERT_TRUE(write_ply(path("far/points.ply"), *cloud));
    auto json = parsed(read("near/cameras.json"));
    for (auto& camera : json["cameras"])
      for (std::size_t i = 0; i < 3; ++i) {
        double t = camera["t"][i].get<double>();
        for (std::size_t j = 0; j < 3; ++j) t -= camera["R"][i][j].get<double>() * kFar[j];
        camera["t"][i] = t;
      }
    write("far/cameras.json", json.dump());
  }

  nlohmann::json reported(const std::string& arguments) {
    const Ran ran = slf(arguments + " --json --threads 2");
    EXPECT_EQ(ran.code, 0) << arguments << ": " << ran.err;
    return parsed(ran.out);
  }

  /// Compares near.slf and far.slf: the same voxels and components, on grids that are kFar apart.
  /// @param others  share of components that may be others
  void expect_same_fields(double others) {
    for (const std::string name : {"near", "far"})
      ASSERT_EQ(slf("decode " + name + ".slf --dump " + name + "_dump").code, 0);
    EXPECT_EQ(read("near_dump/positions.npy"), read("far_dump/positions.npy"));
    const auto a = numbers("near_dump/components.npy"), b = numbers("far_dump/components.npy");
    ASSERT_EQ(a.size(), b.size());
    std::size_t other = 0;
    for (std::size_t i = 0; i < a.size(); ++i) other += a[i] != b[i];
    EXPECT_LE(double(other), others * double(a.size()));
    const auto grid = parsed(read("near_dump/light_field.json"))["grid"],
               moved = parsed(read("far_dump/light_field.json"))["grid"];
    EXPECT_EQ(grid["step"].get<double>(), moved["step"].get<double>());
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(moved["origin"][k].get<double>() - kFar[k], grid["origin"][k].get<double>(),
                  1e-8);
  }

  std::vector<std::int32_t> numbers(const std::string& file) {
    const std::string bytes = read(file);
    const auto array = tools::parse_npy({bytes.begin(), bytes.end()});
    EXPECT_TRUE(array) << file;
    return *tools::int32_values(*array);
  }
};

TEST_F(Georeference, AColouredCloudKeepsItsMillimetresThereAndBack) {
  const std::string options = " --voxel-size 0.0009765625 -q 2 --quiet";
  ASSERT_EQ(slf("encode near/points.ply -o near.slf" + options).code, 0);
  const Ran ran = slf("encode far/points.ply -o far.slf" + options);
  ASSERT_EQ(ran.code, 0);
  EXPECT_EQ(ran.err, "");
  expect_same_fields(0);
  ASSERT_EQ(slf("decode near.slf -o near.ply").code, 0);
  ASSERT_EQ(slf("decode far.slf -o far.ply").code, 0);
  EXPECT_THAT(read("near.ply"), testing::HasSubstr("property float x\n"));
  EXPECT_THAT(read("far.ply"), testing::HasSubstr("property double x\n"));
  // What was decoded is coded again: its colours are rounded, its voxels are where they were.
  ASSERT_EQ(slf("encode far.ply -o far.slf" + options).code, 0);
  expect_same_fields(1);
}

TEST_F(Georeference, ACaptureHasTheFieldFiguresAndPicturesOfTheSameNearZero) {
  for (const std::string name : {"near", "far"})
    reported("encode " + name + " -o " + name +
             ".slf --effort 5 --grid-bits 6 -q 8 --predict off --surface given --split 1/3");
  // Cameras are the same to a nanometre: hardly a coefficient is rounded the other way. (Where two
  // modes of prediction cost the same, one of them can change the mode, and that all of a level.)
  expect_same_fields(0.001);
  const auto near = reported("eval near.slf near"), far = reported("eval far.slf far");
  for (const char* cameras : {"input", "held_out"}) {
    const auto &a = near[cameras], &b = far[cameras];
    EXPECT_NEAR(a["points"][0]["psnr"].get<double>(), b["points"][0]["psnr"].get<double>(), 0.01);
    EXPECT_NEAR(a["image"]["psnr"].get<double>(), b["image"]["psnr"].get<double>(), 0.01);
    EXPECT_EQ(a["points"][0]["observations"], b["points"][0]["observations"]);
  }
  // A camera of the capture and one of a cameras.json are in the world.
  for (const char* camera : {" --capture far --image 1", " --camera far/cameras.json:1"}) {
    ASSERT_EQ(slf("render near.slf -o near.png --camera near/cameras.json:1").code, 0);
    ASSERT_EQ(slf(std::string("render far.slf -o far.png") + camera).code, 0);
    const auto a = read_image(path("near.png")), b = read_image(path("far.png"));
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->data.size(), b->data.size());
    std::size_t other = 0;
    for (std::size_t i = 0; i < a->data.size(); ++i)
      other += std::abs(int{a->data[i]} - int{b->data[i]}) > 2;
    EXPECT_LE(other, a->data.size() / 1000) << camera;
  }
}

}  // namespace
}  // namespace slf::georeference_test
