// SPDX-License-Identifier: Apache-2.0
// Films of slf render: the file is read here as AVI 1.0 says, by no code of ours.
#include <cmath>

#include "cli_support.h"
#include "slf/capture.h"
#include "tests/codec/frames_support.h"

namespace slf::cli_film_test {
namespace {

class CliFilmTest : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    const std::vector<LightField> fields = test::drawn_fields_of(test::Moves::kAppears, 3);
    const test::Bytes bytes =
        test::joined(test::coded_frames(fields, test::frame_parameters(8, 1)));
    write("x.slf", {bytes.begin(), bytes.end()});
  }
};

std::uint32_t number(const std::string& file, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;) value = value << 8 | static_cast<std::uint8_t>(file.at(at + i));
  return value;
}

struct Avi {
  std::uint32_t microseconds = 0, frames = 0, width = 0, height = 0, scale = 0, rate = 0;
  std::vector<std::string> pictures;        // as chunks have them
  std::vector<std::string> index_pictures;  // by the index
};

/// Chunks from `at` to `end`: step(code, at, size) of each.
template <class Step>
void for_chunks(const std::string& file, std::size_t at, std::size_t end, const Step& step) {
  while (at < end) {
    const std::size_t size = number(file, at + 4);
    ASSERT_LE(at + 8 + size, end);
    step(file.substr(at, 4), at + 8, size);
    at += 8 + size + size % 2;
  }
  EXPECT_EQ(at, end);
}

Avi read_avi(const std::string& file) {
  Avi avi;
  std::size_t movie = 0;
  EXPECT_EQ(file.substr(0, 4), "RIFF");
  EXPECT_EQ(number(file, 4) + 8, file.size());
  EXPECT_EQ(file.substr(8, 4), "AVI ");
  const auto of_header = [&](const std::string& code, std::size_t at, std::size_t size) {
    if (code == "avih") {
      EXPECT_EQ(size, 56u);
      avi.microseconds = number(file, at);
      avi.frames = number(file, at + 16);
      avi.width = number(file, at + 32);
      avi.height = number(file, at + 36);
      return;
    }
    EXPECT_EQ(file.substr(at, 4), "strl");
    for_chunks(file, at + 4, at + size, [&](const std::string& part, std::size_t p, std::size_t n) {
      EXPECT_EQ(n, part == "strh" ? 56u : 40u);
      EXPECT_EQ(file.substr(p + (part == "strh" ? 4 : 16), 4), "MJPG");
      if (part == "strh") avi.scale = number(file, p + 20), avi.rate = number(file, p + 24);
    });
  };
  for_chunks(file, 12, file.size(), [&](const std::string& code, std::size_t at, std::size_t size) {
    if (code == "idx1") {
      for (std::size_t i = at; i < at + size; i += 16) {
        EXPECT_EQ(file.substr(i, 4), "00dc");
        avi.index_pictures.push_back(
            file.substr(movie + number(file, i + 8) + 8, number(file, i + 12)));
      }
    } else if (file.substr(at, 4) == "hdrl") {
      for_chunks(file, at + 4, at + size, of_header);
    } else {
      EXPECT_EQ(file.substr(at, 4), "movi");
      movie = at;
      for_chunks(file, at + 4, at + size, [&](const std::string&, std::size_t p, std::size_t n) {
        avi.pictures.push_back(file.substr(p, n));
      });
    }
  });
  return avi;
}

TEST_F(CliFilmTest, FilmOfFramesHasTheirPicturesAndTheirRate) {
  ASSERT_EQ(slf("render x.slf --frames 0:2 --size 62x45 -o v.avi --quiet").code, 0);
  ASSERT_EQ(slf("render x.slf --frames 0:2 --size 62x45 -o v%d.jpg --quiet").code, 0);
  ASSERT_EQ(slf("render x.slf --frames 0:2 --size 62x45 -o v%d.png --quiet").code, 0);
  const Avi avi = read_avi(read("v.avi"));
  EXPECT_EQ(avi.frames, 3u);
  EXPECT_EQ(avi.width, 62u);
  EXPECT_EQ(avi.height, 45u);
  EXPECT_EQ(avi.microseconds, 33333u);
  EXPECT_EQ(avi.rate, 30 * avi.scale);
  ASSERT_EQ(avi.pictures.size(), 3u);
  EXPECT_EQ(avi.pictures, avi.index_pictures);
  for (int f = 0; f < 3; ++f) {
    const std::string name = "v" + std::to_string(f);
    EXPECT_EQ(avi.pictures[static_cast<std::size_t>(f)], read(name + ".jpg"));
    write("one.jpg", avi.pictures[static_cast<std::size_t>(f)]);
    const auto lossy = read_image(path("one.jpg")), exact = read_image(path(name + ".png"));
    ASSERT_TRUE(lossy && exact);
    ASSERT_EQ(lossy->data.size(), exact->data.size());
    double square = 0;
    for (std::size_t i = 0; i < exact->data.size(); ++i)
      square += std::pow(int{lossy->data[i]} - int{exact->data[i]}, 2);
    EXPECT_LT(std::sqrt(square / static_cast<double>(exact->data.size())), 12);
  }
  EXPECT_NE(avi.pictures[0], avi.pictures[1]);
}

TEST_F(CliFilmTest, FramesThatLastUnlikeLongAreShownAtTheirTimes) {
  FrameEncoder encoder(test::frame_parameters(8, 1), 16);
  const std::vector<double> times = {0.5, 0.6, 0.7, 1.1, 1.15};
  test::Bytes bytes;
  const auto fields = test::drawn_fields_of(test::Moves::kAppears, static_cast<int>(times.size()));
  for (std::size_t t = 0; t < times.size(); ++t) {
    const auto frame = encoder.add(fields[t], times[t]);
    ASSERT_TRUE(frame);
    bytes.insert(bytes.end(), frame->begin(), frame->end());
  }
  write("y.slf", {bytes.begin(), bytes.end()});
  ASSERT_EQ(slf("render y.slf --size 32x32 -o v.avi --quiet").code, 0);
  ASSERT_EQ(slf("render y.slf --frames 0:4 --size 32x32 -o v%d.jpg --quiet").code, 0);
  const Avi avi = read_avi(read("v.avi"));
  ASSERT_EQ(avi.frames, avi.pictures.size());
  EXPECT_EQ(avi.pictures, avi.index_pictures);
  for (std::size_t t = 0; t < times.size(); ++t) {
    const double picture = (times[t] - times[0] + 1e-6) * avi.rate / avi.scale;
    EXPECT_EQ(avi.pictures.at(static_cast<std::size_t>(picture)),
              read("v" + std::to_string(t) + ".jpg"))
        << t;
  }
  // A part that is even needs no picture twice.
  ASSERT_EQ(slf("render y.slf --frames 0:2 --size 32x32 -o v.avi --quiet").code, 0);
  const Avi even = read_avi(read("v.avi"));
  EXPECT_EQ(even.pictures.size(), 3u);
  EXPECT_EQ(even.rate, 10 * even.scale);
}

TEST_F(CliFilmTest, WithoutAChoiceHasAllFrames) {
  ASSERT_EQ(slf("render x.slf --frames 0:2 --size 32x32 -o v.avi --quiet").code, 0);
  const Ran ran = slf("render x.slf --size 32x32 -o all.avi");
  ASSERT_EQ(ran.code, 0) << ran.err;
  EXPECT_EQ(read("all.avi"), read("v.avi"));
  for (const char* frame : {"frame 0", "frame 1", "frame 2"})
    EXPECT_NE(ran.err.find(frame), std::string::npos) << ran.err;
  ASSERT_EQ(slf("render - --size 32x32 -o in.avi --quiet <x.slf").code, 0);
  EXPECT_EQ(read("in.avi"), read("v.avi"));
  ASSERT_EQ(slf("render x.slf --frame 1 --size 32x32 -o one.avi --quiet").code, 0);
  EXPECT_EQ(read_avi(read("one.avi")).pictures.size(), 1u);
}

TEST_F(CliFilmTest, FilmOfAnOrbitHasAllViews) {
  ASSERT_EQ(slf("render x.slf --orbit 4 --size 32x32 -o v.AVI --quiet").code, 0);
  ASSERT_EQ(slf("render x.slf --orbit 4 --size 32x32 -o v%d.jpg --quiet").code, 0);
  const Avi avi = read_avi(read("v.AVI"));
  ASSERT_EQ(avi.pictures.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_EQ(avi.pictures[i], read("v" + std::to_string(i) + ".jpg"));
}

TEST_F(CliFilmTest, SheetsOfFramesAreItsPictures) {
  ASSERT_EQ(slf("render x.slf --frames 1:2 --orbit 2 --sheet --size 20x20 -o v.avi --quiet").code,
            0);
  const Avi avi = read_avi(read("v.avi"));
  EXPECT_EQ(avi.pictures.size(), 2u);
  EXPECT_EQ(avi.width, 40u);
}

TEST_F(CliFilmTest, WhatCannotBeIsRefusedInASentence) {
  expect_failure(slf("render x.slf --frames 0:2 -o v.avi --transparent --quiet"), 2, "transparent",
                 "JPEG has no alpha");
  expect_failure(slf("render x.slf --frames 0:2 -o v.avi --orbit 2 --quiet"), 2, "--orbit",
                 "--sheet");
  expect_failure(slf("render x.slf --frames 0:2 -o none/v.avi --quiet"), 7, "none/v.avi",
                 "does not exist");
  expect_failure(slf("render x.slf --frames 0:3 --size 20x20 -o v.avi --quiet"), 2, "x.slf",
                 "it has 3");
  for (const char* name : {"v%d.mkv", "v%d.mp4", "v%d.ivf", "v%d.gif"})
    expect_failure(slf("render x.slf --frames 0:2 --quiet -o " + std::string(name)), 2, ".avi",
                   "it writes");
  expect_failure(slf("decode x.slf --quiet -o v.avi"), 2, "v.avi", "it writes");
  EXPECT_FALSE(exists("v.avi"));
}

}  // namespace
}  // namespace slf::cli_film_test
