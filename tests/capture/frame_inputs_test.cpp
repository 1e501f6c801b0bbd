// SPDX-License-Identifier: Apache-2.0
// Frames of a moving light field as files: order, gaps, and what is refused.
#include "slf/frame_inputs.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "slf/capture.h"

namespace slf::frame_inputs_test {
namespace {

namespace fs = std::filesystem;

class FrameInputsTest : public testing::Test {
 protected:
  FrameInputsTest() {
    std::string name = (fs::temp_directory_path() / "slf_frames_XXXXXX").string();
    root_ = mkdtemp(name.data());
  }
  ~FrameInputsTest() override { fs::remove_all(root_); }

  void cloud(const std::string& name, int points = 1) const {
    PointCloud made;
    for (int i = 0; i < points; ++i) made.positions.push_back({float(i), 0, 0});
    ASSERT_TRUE(write_ply(root_ / name, made));
  }
  /// A capture of cameras without photographs: "a.png", "b.png", of a width each.
  void capture(const std::string& name, const std::vector<std::pair<std::string, int>>& cameras) {
    fs::create_directories(root_ / name);
    std::ofstream json(root_ / name / "cameras.json");
    json << "{\"cameras\": [";
    const char* comma = "";
    for (const auto& [image, width] : cameras) {
      json << comma << "{\"image\": \"" << image << "\", \"width\": " << width
           << ", \"height\": 20, \"K\": [[30, 0, 10], [0, 30, 10], [0, 0, 1]], \"R\": "
              "[[1, 0, 0], [0, 1, 0], [0, 0, 1]], \"t\": [0, 0, 3]}";
      comma = ", ";
    }
    json << "]}";
  }
  std::string refusal(const fs::path& input, std::optional<FrameRange> range = {},
                      Errc code = Errc::kInvalidInput) const {
    const auto frames = list_frames(input, range);
    if (frames) return "accepted";
    EXPECT_EQ(frames.error().code, code) << frames.error().message;
    const std::string prefix = root_.string() + "/";
    const std::string& message = frames.error().message;
    return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
  }
  static std::string listed(const Result<FrameInputs, InputError>& frames) {
    if (!frames) return frames.error().message;
    std::string text = frames->kind == FrameKind::kClouds   ? "clouds"
                       : frames->kind == FrameKind::kSplats ? "splats"
                                                            : "captures";
    for (const FrameInput& frame : frames->frames)
      text += " " + std::to_string(frame.number) + "=" + frame.path.filename().string();
    return text;
  }

  fs::path root_;
};

TEST_F(FrameInputsTest, CloudsOfADirectoryAreInTheOrderOfTheirNumbersWhereverTheseBegin) {
  for (const int number : {1001, 999, 1000})
    cloud("loot_vox10_" + std::string(number < 1000 ? "0" : "") + std::to_string(number) + ".ply");
  std::ofstream(root_ / "readme.txt") << "ours";
  const std::string expected =
      "clouds 999=loot_vox10_0999.ply 1000=loot_vox10_1000.ply 1001=loot_vox10_1001.ply";
  EXPECT_EQ(listed(list_frames(root_)), expected);
  EXPECT_EQ(listed(list_frames(root_ / "loot_vox10_%04d.ply")), expected);
  EXPECT_TRUE(holds_frames(root_));
  EXPECT_TRUE(holds_frames(root_ / "loot_vox10_%04d.ply"));
}

TEST_F(FrameInputsTest, NumbersWithoutZerosInFrontAreNumbersAndNotText) {
  for (const char* name : {"f10.ply", "f9.ply", "f11.ply"}) cloud(name);
  EXPECT_EQ(listed(list_frames(root_)), "clouds 9=f9.ply 10=f10.ply 11=f11.ply");
  EXPECT_EQ(listed(list_frames(root_ / "f%d.ply")), "clouds 9=f9.ply 10=f10.ply 11=f11.ply");
}

TEST_F(FrameInputsTest, ARangeSelectsAndNeedsAllOfIt) {
  for (const char* name : {"a_1.ply", "a_2.ply", "a_3.ply", "a_5.ply"}) cloud(name);
  EXPECT_EQ(listed(list_frames(root_, FrameRange{2, 3})), "clouds 2=a_2.ply 3=a_3.ply");
  EXPECT_EQ(refusal(root_), "a_4.ply: frame 4 is missing");
  EXPECT_EQ(refusal(root_, FrameRange{3, 5}), "a_4.ply: frame 4 is missing");
  EXPECT_EQ(refusal(root_, FrameRange{0, 2}), "a_0.ply: frame 0 is missing");
  EXPECT_EQ(refusal(root_, FrameRange{5, 6}), "a_6.ply: frame 6 is missing");
  EXPECT_EQ(refusal(root_, FrameRange{8, 9}), "a_8.ply: frame 8 is missing");
  EXPECT_EQ(refusal(root_, FrameRange{3, 2}, Errc::kInvalidArgument),
            "frames 3:2: not a range of 0 .. 999999999");
}

TEST_F(FrameInputsTest, AMissingFileHasTheNameThatItWouldHave) {
  cloud("frame_0001.ply");
  cloud("frame_0003.ply");
  EXPECT_EQ(refusal(root_), "frame_0002.ply: frame 2 is missing");
}

TEST_F(FrameInputsTest, OneNumberTwiceAndTwoNamesAreRefused) {
  cloud("a_1.ply");
  cloud("a_01.ply");
  EXPECT_EQ(refusal(root_), "a_1.ply: frame 1 is there twice, as a_01.ply too");
  EXPECT_EQ(listed(list_frames(root_ / "a_%02d.ply")), "clouds 1=a_01.ply");
  fs::remove(root_ / "a_01.ply");
  cloud("b_2.ply");
  EXPECT_EQ(refusal(root_),
            "b_2.ply: another name than a_1.ply; a pattern as a_%04d.ply says which frames are "
            "meant");
  EXPECT_EQ(listed(list_frames(root_ / "b_%d.ply")), "clouds 2=b_2.ply");
}

TEST_F(FrameInputsTest, SplatsOfOtherFormatsBesideACloudAreNotLostWithoutAWord) {
  for (const char* name : {"a_0001.spz", "a_0002.spz"}) std::ofstream(root_ / name) << "splats";
  cloud("a_0003.ply");
  EXPECT_EQ(refusal(root_),
            "a_0003.ply: another name than a_0001.spz; a pattern as a_%04d.spz says which frames "
            "are meant");
  cloud("z_1.ply");
  EXPECT_NE(refusal(root_), "accepted");
}

TEST_F(FrameInputsTest, CamerasOfNumberedImagesStandForTheirFolder) {
  capture("moving", {{"%04d.png", 20}});
  for (const char* name : {"0001.png", "0002.png"})
    ASSERT_TRUE(
        write_png(root_ / "moving" / name, Image{20, 20, 3, std::vector<std::uint8_t>(1200)}));
  EXPECT_TRUE(holds_frames(root_ / "moving/cameras.json"));
  EXPECT_EQ(listed(list_frames(root_ / "moving/cameras.json")),
            listed(list_frames(root_ / "moving")));
  capture("wide", {{"%05d.png", 20}});
  EXPECT_EQ(refusal(root_ / "wide"), "wide: no file has a name as %05d.png");
  capture("percent", {{"100%d.png", 20}, {"one.png", 20}});  // a name like any other
  for (const char* name : {"100%d.png", "one.png"})
    ASSERT_TRUE(
        write_png(root_ / "percent" / name, Image{20, 20, 3, std::vector<std::uint8_t>(1200)}));
  EXPECT_FALSE(holds_frames(root_ / "percent"));
  capture("still", {{"one.png", 20}});
  EXPECT_FALSE(holds_frames(root_ / "still/cameras.json"));
}

TEST_F(FrameInputsTest, ACloudMayHaveNoPointsAndAFileMayNotBeEmpty) {
  cloud("a_1.ply", 0);
  cloud("a_2.ply");
  EXPECT_EQ(listed(list_frames(root_)), "clouds 1=a_1.ply 2=a_2.ply");
  fs::resize_file(root_ / "a_2.ply", 0);
  EXPECT_EQ(refusal(root_), "a_2.ply: the frame is empty");
  std::ofstream(root_ / "a_2.ply") << "no ply";
  EXPECT_NE(refusal(root_).find("a_2.ply"), std::string::npos);
}

TEST_F(FrameInputsTest, NothingThereIsSaid) {
  EXPECT_NE(refusal(root_).find("no frames"), std::string::npos);
  EXPECT_EQ(refusal(root_ / "x_%04d.ply"), "x_%04d.ply: no file has such a name");
  EXPECT_NE(refusal(root_ / "none" / "x_%d.ply", {}, Errc::kUnreadable).find("none"),
            std::string::npos);
  for (const char* name : {"x_%04x.ply", "x_%d_%d.ply", "x_%10d.ply", "x.ply"})
    EXPECT_NE(refusal(root_ / name, {}, Errc::kInvalidArgument).find("pattern"), std::string::npos);
  EXPECT_FALSE(holds_frames(root_));
  EXPECT_FALSE(holds_frames(root_ / "x.ply"));
}

TEST_F(FrameInputsTest, CapturesNeedTheSameCamerasInAnyOrder) {
  capture("frame_0001", {{"a.png", 20}, {"b.png", 24}});
  capture("frame_0002", {{"b.png", 24}, {"a.png", 20}});
  EXPECT_EQ(listed(list_frames(root_)), "captures 1=frame_0001 2=frame_0002");
  EXPECT_EQ(listed(list_frames(root_ / "frame_%04d")), "captures 1=frame_0001 2=frame_0002");
  EXPECT_TRUE(holds_frames(root_));
  EXPECT_FALSE(holds_frames(root_ / "frame_0001"));

  capture("frame_0002", {{"a.png", 20}});
  EXPECT_EQ(refusal(root_), "frame_0002: no camera b.png, which frame_0001 has");
  capture("frame_0002", {{"a.png", 20}, {"c.png", 24}});
  EXPECT_EQ(refusal(root_), "frame_0002: no camera b.png, which frame_0001 has");
  capture("frame_0002", {{"a.png", 20}, {"aa.png", 20}, {"b.png", 24}});
  EXPECT_EQ(refusal(root_), "frame_0002: camera aa.png, which frame_0001 has not");
  capture("frame_0002", {{"a.png", 20}, {"b.png", 25}});
  EXPECT_EQ(refusal(root_), "frame_0002: camera b.png is of 25 x 20, in frame_0001 of 24 x 20");
}

TEST_F(FrameInputsTest, CapturesBesideCloudsAndEmptyCapturesAreRefused) {
  capture("frame_0001", {{"a.png", 20}});
  cloud("frame_0002.ply");
  EXPECT_EQ(refusal(root_),
            "frame_0002.ply: a cloud beside frame_0001: frames are all captures or all clouds");
  fs::remove(root_ / "frame_0002.ply");
  fs::create_directory(root_ / "frame_0002");
  EXPECT_EQ(refusal(root_), "frame_0002: the frame is empty");
  std::ofstream(root_ / "frame_0002" / "notes.txt") << "later";
  EXPECT_NE(refusal(root_).find("frame_0002"), std::string::npos);
}

TEST(FrameRangeTest, IsTwoNumbersOrOne) {
  const auto both = parse_frame_range("3:17"), one = parse_frame_range("5");
  ASSERT_TRUE(both && one);
  EXPECT_EQ(both->first, 3u);
  EXPECT_EQ(both->last, 17u);
  EXPECT_EQ(one->first, 5u);
  EXPECT_EQ(one->last, 5u);
  for (const char* text : {"", ":", "3:", ":3", "4:3", "-1:3", "1:2:3", "1,2", "1:2 ", "a",
                           "4294967296", "1:1000000000"}) {
    const auto range = parse_frame_range(text);
    ASSERT_FALSE(range) << text;
    EXPECT_EQ(range.error().code, Errc::kInvalidArgument);
  }
}

}  // namespace
}  // namespace slf::frame_inputs_test
