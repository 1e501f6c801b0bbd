// SPDX-License-Identifier: Apache-2.0
// Sequences of captures and clouds through the program: planned, coded, judged frame by frame.
#include "cli_support.h"
#include "slf/capture.h"
#include "tests/lightfield/gaussian_support.h"

namespace slf::cli_sequence_test {
namespace {

namespace fs = std::filesystem;

class SequenceTest : public CliTest {
 protected:
  void draw(const std::string& frames = "3") {
    const Ran drawn = slf("synth turn --frames " + frames +
                          " --size 24x24 --points 400 --circles 1 --per-circle 8 -o take --quiet");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
  }
  void cloud(const std::string& name, int points, float z = 0) {
    PointCloud made;
    for (int i = 0; i < points; ++i) {
      made.positions.push_back({static_cast<float>(i % 20), static_cast<float>(i / 20), z});
      made.colours.push_back({static_cast<std::uint8_t>(10 * (i % 20)), 90, 40});
    }
    ASSERT_TRUE(write_ply(path(name), made));
  }
};

TEST_F(SequenceTest, ADryRunSaysWhatWouldBeDoneAndWritesNothing) {
  for (int f = 0; f < 5; ++f) cloud("c_" + std::to_string(f) + ".ply", f == 2 ? 0 : 200 + f);
  const std::string command = "encode c_%d.ply -o x.slf --group 4 --rate 10 --json --quiet";
  const Ran planned = slf(command + " --dry-run");
  ASSERT_EQ(planned.code, 0) << planned.err;
  EXPECT_FALSE(exists("x.slf"));
  const auto plan = parsed(planned.out), coded = parsed(slf(command).out);
  EXPECT_EQ(plan["rate"], 10);
  ASSERT_EQ(plan["frames"].size(), 5u);
  for (std::size_t f = 0; f < 5; ++f) {
    EXPECT_EQ(plan["frames"][f]["number"], coded["frames"][f]["number"]);
    EXPECT_EQ(plan["frames"][f]["predicted"], coded["frames"][f]["predicted"]) << f;
    EXPECT_EQ(plan["frames"][f]["points"], coded["frames"][f]["points"]) << f;
  }
  const auto header = parsed(slf("info x.slf --json").out)["header"];
  EXPECT_EQ(plan["grid"]["step"], header["grid"]["step"]);
  const Ran text = slf("encode c_%d.ply -o y.slf --dry-run --part 2/2 --group 4");
  EXPECT_NE(text.out.find("frames        1, 4 to 4"), std::string::npos) << text.out;
  EXPECT_FALSE(exists("y.slf"));
  expect_failure(slf("encode c_%d.ply -o x.slf --dry-run --densify on"), 2, "--densify on",
                 "as they are given");
}

TEST_F(SequenceTest, ColoursOfViewsAreNotLeftOutUnlessAskedFor) {
  ASSERT_EQ(slf("synth can --plenoptic 5 --points 500 -o p_1.ply --quiet").code, 0);
  fs::copy_file(path("p_1.ply"), path("p_2.ply"));
  for (const bool all : {true, false}) {
    const Ran ran =
        slf("encode p_%d.ply -o x.slf --quiet" + std::string(all ? "" : " --as colour"));
    ASSERT_EQ(ran.code, 0) << ran.err;
    ASSERT_EQ(slf("decode x.slf --frame 1 -o d.ply --quiet").code, 0);
    EXPECT_EQ(read("d.ply").find("property uchar red_4\n") != std::string::npos, all);
  }
}

TEST_F(SequenceTest, EvalJudgesEachFrameAndTheMeanOfAll) {
  draw();
  ASSERT_EQ(slf("encode take -o x.slf --effort 1 --quiet --split all").code, 0);
  const Ran ran = slf("eval x.slf take --json --quiet");
  ASSERT_EQ(ran.code, 0) << ran.err;
  const auto all = parsed(ran.out);
  ASSERT_EQ(all["frames"].size(), 3u);
  EXPECT_EQ(all["bytes"], read("x.slf").size());
  EXPECT_EQ(all["input"]["cameras"], 8) << "the file says which split it was made from";
  double points = 0, pictures = 0;
  for (std::size_t f = 0; f < 3; ++f) {
    const std::string place = std::to_string(f), number = std::to_string(f + 1);
    const auto one =
        parsed(slf("eval x.slf take/frame_000" + number + " --frame " + place + " --json").out);
    const auto& frame = all["frames"][f];
    EXPECT_EQ(frame["number"], f + 1);
    EXPECT_EQ(frame["bytes"], one["bytes"]);
    EXPECT_EQ(frame["input"], one["input"]);
    EXPECT_EQ(parsed(slf("eval x.slf take --frame " + place + " --json").out)["input"],
              one["input"]);
    points += one["input"]["points"][0]["psnr"].get<double>() / 3;
    pictures += one["input"]["image"]["psnr"].get<double>() / 3;
  }
  EXPECT_NEAR(all["input"]["points"][0]["psnr"].get<double>(), points, 1e-9);
  EXPECT_NEAR(all["input"]["image"]["psnr"].get<double>(), pictures, 1e-9);
  const Ran text = slf("eval x.slf take --quiet --error-map maps");
  for (const char* said : {"frame_0002", "mean over frames", "3 frames"})
    EXPECT_NE(text.out.find(said), std::string::npos) << text.out;
  EXPECT_TRUE(exists("maps/frame_0003"));
  expect_failure(slf("eval x.slf take --min-image-psnr 99 --quiet >/dev/null"), 8, "x.slf", "99");
}

TEST_F(SequenceTest, EvalOfOtherFramesThanTheFileHasNamesTheRange) {
  draw();
  ASSERT_EQ(slf("encode take --frames 2:3 -o x.slf --effort 1 --quiet").code, 0);
  expect_failure(slf("eval x.slf take --quiet"), 2, "x.slf has 2 frames", "--frames A:B");
  const Ran ran = slf("eval x.slf take --frames 2:3 --json --quiet --no-images");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(parsed(ran.out)["frames"][0]["number"], 2);
  expect_failure(slf("eval x.slf take --frames 3:4"), 4, "frame_0004", "is missing");
}

TEST_F(SequenceTest, ImagesOfEachFrameAreFoundByItsNameOrItsNumber) {
  draw("2");
  const std::string options = " --effort 1 --quiet -o ";
  ASSERT_EQ(slf("encode take" + options + "x.slf").code, 0);
  for (const char* number : {"1", "2"}) {
    const std::string frame = std::string("frame_000") + number;
    fs::create_directories(path("photographs/" + frame));
    fs::rename(path("take/" + frame + "/images"), path("photographs/" + frame + "/images"));
    fs::create_directories(path("by_number"));
    fs::create_directory_symlink(path("photographs/" + frame),
                                 path(std::string("by_number/") + number));
  }
  for (const char* images : {"photographs", "by_number/%d"}) {
    ASSERT_EQ(slf("encode take" + options + "y.slf --images " + images).code, 0) << images;
    EXPECT_EQ(read("x.slf"), read("y.slf"));
  }
  fs::remove_all(path("photographs/frame_0002"));
  expect_failure(slf("encode take -o z.slf --quiet --images photographs"), 3,
                 "photographs/frame_0002", "photographs of frame 2");
}

TEST_F(SequenceTest, AFrameThatLacksOrChangesAPhotographIsNamed) {
  draw("2");
  const fs::path image = path("take/frame_0002/images");
  fs::path first;
  for (const auto& entry : fs::directory_iterator(image))
    if (first.empty() || entry.path() < first) first = entry.path();
  const std::string name = "take/frame_0002/images/" + first.filename().string();
  ASSERT_TRUE(write_png(first, Image{20, 24, 3, std::vector<std::uint8_t>(20 * 24 * 3)}));
  expect_failure(slf("encode take -o x.slf --quiet --effort 1"), 4, name, "20 x 24");
  fs::remove(first);
  expect_failure(slf("encode take -o x.slf --quiet --effort 1"), 3, name, "");
  fs::remove(path("take/frame_0002/cameras.json"));
  expect_failure(slf("encode take -o x.slf --quiet --effort 1"), 4, "take/frame_0002",
                 "not a capture");
  fs::remove_all(path("take/frame_0002"));
  fs::create_directory(path("take/frame_0002"));
  expect_failure(slf("encode take -o x.slf --quiet"), 4, "take/frame_0002", "the frame is empty");
  fs::rename(path("take/frame_0002"), path("take/frame_0003"));
  expect_failure(slf("encode take -o x.slf --quiet"), 4, "take/frame_0002", "frame 2 is missing");
  expect_failure(slf("encode take --frames 3:1 -o x.slf --quiet"), 2, "3:1", "A <= B");
  EXPECT_FALSE(exists("x.slf"));
}

TEST_F(SequenceTest, CloudsOutOfOrderTwiceAndWithoutColoursAreNamed) {
  for (const char* name : {"a_1.ply", "a_01.ply", "a_2.ply"}) cloud(name, 200);
  expect_failure(slf("encode . -o x.slf --quiet"), 4, "a_1.ply", "frame 1 is there twice");
  fs::remove(path("a_01.ply"));
  PointCloud bare;
  for (int i = 0; i < 50; ++i)
    bare.positions.push_back({static_cast<float>(i % 7), static_cast<float>(i), 0});
  ASSERT_TRUE(write_ply(path("a_2.ply"), bare));
  expect_failure(slf("encode a_%d.ply -o x.slf --quiet"), 4, "a_2.ply", "colour");
  EXPECT_FALSE(exists("x.slf"));
}

/// The captures of `take` as one in `one`, with images and clouds by frame.
class OneCaptureTest : public SequenceTest {
 protected:
  void SetUp() override {
    SequenceTest::SetUp();
    draw("2");
    std::string json = read("take/frame_0001/cameras.json");
    const auto cameras = parsed(json)["cameras"];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
      const auto image = cameras[i]["image"].get<std::string>();
      const std::string folder = "cam_" + std::to_string(i);
      fs::create_directories(path("one/" + folder));
      for (const char* number : {"1", "2"})
        fs::copy_file(path(std::string("take/frame_000") + number + "/" + image),
                      path("one/" + folder + "/000" + number + ".png"));
      for (std::size_t at = json.find(image); at != std::string::npos; at = json.find(image))
        json.replace(at, image.size(), folder + "/%04d.png");
    }
    fs::create_directories(path("one/points"));
    for (const char* number : {"1", "2"})
      fs::copy_file(path(std::string("take/frame_000") + number + "/points.ply"),
                    path(std::string("one/points/") + number + ".ply"));
    json.insert(json.find('{') + 1, "\"points\": \"points/%d.ply\", ");
    write("one/cameras.json", json);
  }
};

TEST_F(OneCaptureTest, WithImagesByFrameIsWhatADirectoryOfCapturesIs) {
  for (const char* input : {"take", "one"}) {
    const Ran ran =
        slf(std::string("encode ") + input + " --effort 1 --quiet -o " + input + ".slf");
    ASSERT_EQ(ran.code, 0) << ran.err;
  }
  EXPECT_EQ(read("take.slf"), read("one.slf"));
  const auto of_take = parsed(slf("eval take.slf take --json --quiet").out),
             of_one = parsed(slf("eval one.slf one --json --quiet").out);
  ASSERT_EQ(of_one["frames"].size(), 2u);
  EXPECT_EQ(of_one["frames"][1]["input"], of_take["frames"][1]["input"]);
  EXPECT_EQ(of_one["frames"][1]["number"], 2);
}

TEST_F(OneCaptureTest, AMissingPhotographAndAnImageWithoutANumberAreNamed) {
  fs::remove(path("one/cam_1/0002.png"));
  expect_failure(slf("encode one -o x.slf --quiet"), 4, "cam_1/0002.png",
                 "the photograph is missing of frame 2");
  EXPECT_EQ(slf("encode one -o x.slf --quiet --effort 1 --frames 1:1").code, 0);
  std::string json = read("one/cameras.json");
  const std::string image = "cam_0/%04d.png";
  for (std::size_t at = json.find(image); at != std::string::npos; at = json.find(image))
    json.replace(at, image.size(), "cam_0/0001.png");
  write("one/cameras.json", json);
  expect_failure(slf("encode one -o y.slf --quiet"), 4, "cameras.json", "cam_0/0001.png");
  EXPECT_FALSE(exists("y.slf"));
}

TEST_F(SequenceTest, ExportWritesEachFrame) {
  for (int f = 0; f < 3; ++f)
    cloud("c_" + std::to_string(f) + ".ply", 200 + f, static_cast<float>(f));
  ASSERT_EQ(slf("encode c_%d.ply -o x.slf --quiet").code, 0);
  ASSERT_EQ(slf("export x.slf --frames 1:2 -o s%02d.ply --quiet").code, 0);
  for (const char* place : {"1", "2"}) {
    ASSERT_EQ(slf("export x.slf --frame " + std::string(place) + " -o one.ply --quiet").code, 0);
    EXPECT_EQ(read("one.ply"), read("s0" + std::string(place) + ".ply"));
  }
  EXPECT_FALSE(exists("s00.ply"));
  expect_failure(slf("export x.slf --frames 1:2 -o s.ply --quiet"), 2, "s.ply", "no %d");
  expect_failure(slf("export x.slf --frames 1:3 -o e%d.ply --quiet"), 2, "x.slf", "it has 3");
  const auto bytes = gaussian_file(test::random_gaussians(50, 1), SplatFormat::kPly);
  write("splats.ply", {bytes->begin(), bytes->end()});
  expect_failure(slf("export splats.ply --frame 1 -o y.spz --quiet"), 2, "splats.ply", "no part");
}

}  // namespace
}  // namespace slf::cli_sequence_test
