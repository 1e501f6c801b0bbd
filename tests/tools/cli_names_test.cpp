// SPDX-License-Identifier: Apache-2.0
// Names that people give: cameras by their photographs, outputs by their formats; and what is said
// of a file that was written.
#include "capture/upright.h"
#include "cli_support.h"
#include "slf/jpeg.h"

namespace slf::cli_names_test {
namespace {

class CliNames : public TinyCaptureTest {
 protected:
  void SetUp() override {
    TinyCaptureTest::SetUp();
    const Ran ran = slf("encode tiny -o x.slf --effort 1 -q 16 --quiet");
    ASSERT_EQ(ran.code, 0) << ran.err;
  }
  /// The photograph that a camera is of.
  std::string drawn(const std::string& camera) const {
    const Ran ran = slf("render x.slf --json -o y.png " + camera);
    EXPECT_EQ(ran.code, 0) << ran.err;
    return ran.code == 0 ? parsed(ran.out)["images"][0]["camera"].get<std::string>() : "";
  }
};

TEST_F(CliNames, ACameraGoesByItsPhotographBeforeItsNumber) {
  const auto cameras = parsed(read("tiny/cameras.json"))["cameras"];
  const std::string image = cameras[11]["image"], first = cameras[0]["image"];
  const std::filesystem::path name(image);
  for (const std::string& given : {image, name.filename().string(), name.stem().string(),
                                   std::filesystem::path(name).replace_extension().string()}) {
    EXPECT_EQ(drawn("--camera tiny/cameras.json:" + given), image) << given;
    EXPECT_EQ(drawn("--capture tiny --image " + given), image) << given;
  }
  EXPECT_EQ(drawn("--camera tiny/cameras.json:11"), image) << "no photograph has that name";
  const Ran none = slf("render x.slf --camera tiny/cameras.json:1234567 -o y.png");
  expect_failure(none, 4, "has no camera 1234567", "100 are named as " + first);
}

TEST_F(CliTest, APhotographThatIsStoredTurnedIsShownUprightBesideItsRendering) {
  ASSERT_EQ(slf("synth can -o can --size 48x32 --points 1500 --circles 3 --per-circle 4").code, 0);
  ASSERT_EQ(slf("encode can -o x.slf --effort 1 --quiet").code, 0);
  auto json = parsed(read("can/cameras.json"));
  const std::string first = json["cameras"][0]["image"], turned = "images/turned.jpg";
  const auto seen = read_image(path("can/" + first));
  ASSERT_TRUE(seen);
  const auto stored = encode_jpeg(upright(*seen, 8), 95);  // turned to the left: 6 turns it back
  ASSERT_TRUE(stored);
  const std::string exif(
      "\xFF\xE1\0\x22"
      "Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0\x06\0\0\0\0\0\0",
      36);
  const std::string whole(stored->begin(), stored->end());
  write("can/" + turned, whole.substr(0, 2) + exif + whole.substr(2));
  std::string text = json.dump();
  for (std::size_t at; (at = text.find(first)) != text.npos;)
    text.replace(at, first.size(), turned);
  write("can/cameras.json", text);
  const Ran ran = slf("render x.slf --capture can --image turned.jpg --pair -o pair.png");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto pair = read_image(path("pair.png"));
  ASSERT_TRUE(pair);
  ASSERT_EQ(pair->width, 96);
  ASSERT_EQ(pair->height, 32);
  double difference = 0;
  for (std::size_t y = 0; y < 32; ++y)
    for (std::size_t x = 0; x < 48; ++x)
      difference += std::abs(int{pair->data[3 * (96 * y + x)]} - int{seen->data[3 * (48 * y + x)]});
  EXPECT_LT(difference / (32 * 48), 6) << "of JPEG at 95";
}

TEST_F(CliNames, AnOutputIsWhatItsNameSays) {
  expect_failure(slf("decode x.slf -o x.obj"), 2, "x.obj", "writes .ply, no .obj");
  expect_failure(slf("render x.slf -o x.webp"), 2, "x.webp", "writes .png, .jpg, .jpeg");
  expect_failure(slf("render x.slf -o x.avif"), 2, "x.avif", "writes .png, .jpg, .jpeg");
  expect_failure(slf("encode tiny -o x.html"), 2, "x.html", "writes .slf, no .html");
  expect_failure(slf("render x.slf --transparent -o x.jpg"), 2, "--transparent", "PNG");
  EXPECT_FALSE(exists("x.obj") || exists("x.webp") || exists("x.html") || exists("x.jpg"));
  ASSERT_EQ(slf("render x.slf -o x.JPG --size 20x20").code, 0);
  EXPECT_EQ(read("x.JPG").substr(0, 2), "\xFF\xD8");
  ASSERT_EQ(slf("render x.slf -o other --size 20x20").code, 0);
  EXPECT_EQ(read("other").substr(1, 3), "PNG");
}

TEST_F(CliNames, TheReportOfAnEncodeIsWhatEvalMeasures) {
  for (const char* q : {"2", "64"}) {
    const Ran encoded = slf(std::string("encode tiny -o y.slf --effort 1 --json -q ") + q);
    ASSERT_EQ(encoded.code, 0) << encoded.err;
    const auto pictures = parsed(encoded.out)["pictures"];
    EXPECT_EQ(pictures["cameras"], 20);
    const Ran eval = slf("eval y.slf tiny --json");
    EXPECT_EQ(pictures["psnr"], parsed(eval.out)["input"]["image"]["psnr"]);
  }
}

TEST_F(CliNames, MasksThatLeaveNothingGiveNoFigureAndAWarning) {
  auto cameras = parsed(read("tiny/cameras.json"));
  for (auto& camera : cameras["cameras"]) camera["mask"] = "mask.png";
  write("tiny/cameras.json", cameras.dump());
  ASSERT_EQ(slf("render x.slf --size 48x48 --background 0,0,0 --camera tiny/cameras.json -o "
                "black.png")
                .code,
            0);
  // A picture of one colour: what a view from far away shows.
  ASSERT_EQ(shell("cp black.png tiny/mask.png").code, 0);
  auto far = cameras["cameras"][0];
  far["t"] = {0, 0, -1000};
  write("far.json", nlohmann::json{{"cameras", {far}}}.dump());
  ASSERT_EQ(slf("render x.slf --background 0,0,0 --camera far.json -o tiny/mask.png").code, 0);
  const Ran encoded = slf("encode tiny -o y.slf --effort 1 -q 16");
  EXPECT_NE(encoded.err.find("are they inverted?"), std::string::npos) << encoded.err;
  EXPECT_EQ(encoded.err.find("nan"), std::string::npos) << encoded.err;
  if (encoded.code != 0) return;
  const Ran eval = slf("eval y.slf tiny");
  EXPECT_EQ(eval.out.find("nan"), std::string::npos) << eval.out;
}

TEST_F(CliNames, OptionsOfScenesThatMoveAndOfThoseThatDoNotAreToldApart) {
  expect_failure(slf("synth can --frames 3 -o m"), 2, "can does not move", "rot1");
  expect_failure(slf("synth turn --mesh -o m"), 2, "turn moves", "--mesh");
  expect_failure(slf("synth rot1 --frames 0 -o m"), 2, "--frames", "1 to 9999");
  expect_failure(slf("synth rot1 --points 500 -o m"), 2, "rot1", "--points");
  EXPECT_FALSE(std::filesystem::exists(path("m")));
  ASSERT_EQ(slf("synth rot1 --frames 2 --bits 5 -o m --quiet").code, 0);
  for (const char* file : {"m/frame_0001.ply", "m/frame_0002.ply"})
    EXPECT_NE(read(file).find("element vertex"), std::string::npos) << file;
}

}  // namespace
}  // namespace slf::cli_names_test
