// SPDX-License-Identifier: Apache-2.0
// A sequence that several processes code: parts of whole groups, and what joins them. Frames of no
// points among them.
#include "slf/join_frames.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "slf/frames.h"

namespace slf::frames_parts_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using testing::HasSubstr;

constexpr std::size_t kFrames = 11;

/// A disc that turns and rises, coloured by where its points are on it; nobody in `empty` frames.
LoadedFrame disc(std::size_t f, const std::set<std::size_t>& empty) {
  LoadedFrame frame;
  if (empty.contains(f)) return frame;
  const double angle = 0.04 * static_cast<double>(f);
  for (int i = 0; i < 900; ++i) {
    const double turn = 2.399963 * i, r = std::sqrt(i / 900.0);
    frame.capture.cloud.positions.push_back(
        {static_cast<float>(r * std::cos(turn + angle)),
         static_cast<float>(r * std::sin(turn + angle)),
         static_cast<float>(0.2 * r * std::cos(3 * turn) + 0.01 * static_cast<double>(f))});
    const auto grey = static_cast<std::uint8_t>(128 + 100 * std::sin(7 * r + turn));
    frame.capture.cloud.colours.push_back({grey, 90, static_cast<std::uint8_t>(255 - grey)});
  }
  return frame;
}

EncoderSettings settings() {
  EncoderSettings settings;
  settings.grid_bits = 6;
  settings.threads = 1;
  return settings;
}

Result<Bytes, InputError> coded(const FrameSettings& frames,
                                const std::set<std::size_t>& empty = {},
                                EncodedFrames* told = nullptr) {
  Bytes stream;
  auto encoded = encode_frames(
      kFrames, [&](std::size_t f) { return Result<LoadedFrame, InputError>(disc(f, empty)); },
      settings(), frames,
      [&](std::size_t, std::span<const std::uint8_t> bytes) {
        stream.insert(stream.end(), bytes.begin(), bytes.end());
        return Result<Done, InputError>(Done{});
      });
  if (!encoded) return encoded.error();
  if (told != nullptr) *told = *std::move(encoded);
  return stream;
}

FrameSettings part_of(int part, int parts, int group = 3) {
  return {.group = group, .rate = 25, .hold_over_groups = false, .part = part, .parts = parts};
}

std::vector<PartStream> parts_of(int parts, const std::set<std::size_t>& empty = {}) {
  std::vector<PartStream> all;
  for (int i = 0; i < parts; ++i)
    all.push_back({"part " + std::to_string(i), *coded(part_of(i, parts), empty)});
  return all;
}

TEST(FramesInParts, AreTheBytesOfOneProcessHoweverTheyAreDivided) {
  for (const std::set<std::size_t>& empty :
       {std::set<std::size_t>{}, std::set<std::size_t>{0, 1, 4, 8}}) {
    const Bytes whole = *coded({.group = 3, .rate = 25}, empty);
    for (const int parts : {1, 2, 3, 4}) {
      auto all = parts_of(parts, empty);
      std::rotate(all.begin(), all.begin() + 1, all.end());  // in any order
      const auto joined = join_frames(all);
      ASSERT_TRUE(joined) << joined.error().message;
      EXPECT_EQ(*joined, whole) << parts;
    }
  }
}

TEST(FramesInParts, EveryFrameIsInOneOfThem) {
  for (const int group : {1, 3, 16})
    for (int parts = 1; parts <= 4; ++parts) {
      std::size_t next = 0;
      for (int part = 0; part < parts; ++part) {
        const FramesOfPart own = frames_of_part(kFrames, part_of(part, parts, group));
        if (own.count == 0) continue;
        EXPECT_EQ(own.first, next);
        EXPECT_EQ(own.first % static_cast<std::size_t>(group), 0u);
        next = own.first + own.count;
      }
      EXPECT_EQ(next, kFrames);
    }
}

TEST(FramesInParts, MorePartsThanGroupsAndABitrateAreRefused) {
  EXPECT_THAT(coded(part_of(0, 5)).error().message, HasSubstr("more parts than groups"));
  EXPECT_FALSE(coded(part_of(2, 2)));
  EXPECT_FALSE(coded(part_of(-1, 2)));
  FrameSettings held = part_of(0, 2);
  held.hold_over_groups = true;
  EXPECT_THAT(coded(held).error().message, HasSubstr("within groups"));
}

TEST(JoinFrames, NamesWhatDoesNotGoTogether) {
  const auto parts = parts_of(3);
  const auto refused = [](std::vector<PartStream> some) {
    const auto joined = join_frames(some);
    return joined ? std::string("joined") : joined.error().message;
  };
  EXPECT_THAT(refused({parts[0], parts[2]}), HasSubstr("part 2: frame 3 is missing"));
  EXPECT_THAT(refused({parts[2], parts[1]}),
              HasSubstr("part 1: its first frame is 3: frames 0 to 2 are missing"));
  EXPECT_THAT(refused({parts[1]}), HasSubstr("frames 0 to 2 are missing"));
  EXPECT_THAT(refused({parts[1], parts[0], parts[1]}), HasSubstr("is in part 1 too"));
  PartStream cut = parts[0];
  cut.bytes.pop_back();
  EXPECT_THAT(refused({cut, parts[1]}), HasSubstr("part 0: its last frame is cut short"));
  EXPECT_THAT(refused({parts[0], {"text", {'a', 'b'}}}), HasSubstr("text: no stream of frames"));
  FrameSettings other = part_of(1, 3);
  EncoderSettings coarse = settings();
  coarse.grid_bits = 5;
  Bytes stream;
  ASSERT_TRUE(encode_frames(
      kFrames, [&](std::size_t f) { return Result<LoadedFrame, InputError>(disc(f, {})); }, coarse,
      other,
      [&](std::size_t, std::span<const std::uint8_t> bytes) {
        stream.insert(stream.end(), bytes.begin(), bytes.end());
        return Result<Done, InputError>(Done{});
      }));
  EXPECT_THAT(refused({parts[0], {"coarse", stream}, parts[2]}), HasSubstr("coarse: grid"));
  EXPECT_FALSE(join_frames({}));
}

TEST(JoinFrames, AsGivenNumbersAndTimesGoOn) {
  const auto parts = parts_of(2, {4});
  const auto joined = join_frames(std::vector{parts[1], parts[0], parts[1]}, JoinOrder::kAsGiven);
  ASSERT_TRUE(joined) << joined.error().message;
  auto decoder = FrameDecoder::open(*joined);
  ASSERT_TRUE(decoder) << to_string(decoder.error());
  const auto& frames = decoder->frames();
  const std::size_t second = list_frames(parts[1].bytes)->size(), first = kFrames - second;
  ASSERT_EQ(frames.size(), 2 * second + first);
  const Bytes in_order = *join_frames(parts);
  auto whole = FrameDecoder::open(in_order);
  for (std::size_t f = 0; f < frames.size(); ++f) {
    EXPECT_EQ(frames[f].number, frames[0].number + f);
    if (f > 0) {
      EXPECT_NEAR(frames[f].time - frames[f - 1].time, 1.0 / 25, 1e-9);
    }
    const std::size_t was = f < second ? first + f : f - second;
    const auto field = decoder->decode(f);
    ASSERT_TRUE(field) << f << to_string(field.error());
    EXPECT_EQ(field->num_points(), whole->decode(was)->num_points()) << f;
  }
}

TEST(FramesWithoutPoints, AreEmptyAndTheFirstThatHasSomeChooses) {
  EncodedFrames told;
  const Bytes stream = *coded({.group = 4, .rate = 25}, {0, 5, 10}, &told);
  ASSERT_EQ(told.frames.size(), kFrames);
  auto decoder = FrameDecoder::open(stream);
  ASSERT_TRUE(decoder);
  for (std::size_t f = 0; f < kFrames; ++f) {
    const bool empty = f == 0 || f == 5 || f == 10;
    EXPECT_EQ(told.frames[f].points == 0, empty) << f;
    EXPECT_EQ(told.frames[f].predicted, decoder->frames()[f].predicted) << f;
    const auto field = decoder->decode(f);
    ASSERT_TRUE(field) << f << to_string(field.error());
    EXPECT_EQ(field->num_points() == 0, empty) << f;
  }
}

TEST(FramesWithoutPoints, AloneAreRefused) {
  std::set<std::size_t> all;
  for (std::size_t f = 0; f < kFrames; ++f) all.insert(f);
  EXPECT_THAT(coded({}, all).error().message, HasSubstr("none has points"));
}

TEST(FramesWithoutPoints, KeepABitrate) {
  EncoderSettings rated = settings();
  rated.target_bitrate = 120e3;
  std::size_t bytes = 0;
  const auto encoded = encode_frames(
      kFrames,
      [&](std::size_t f) {
        return Result<LoadedFrame, InputError>(disc(f, {0, 1, 6}));
      },
      rated, {.group = 4, .rate = 25},
      [&](std::size_t, std::span<const std::uint8_t> frame) {
        bytes += frame.size();
        return Result<Done, InputError>(Done{});
      });
  ASSERT_TRUE(encoded) << encoded.error().message;
  EXPECT_TRUE(encoded->warnings.empty());
  const double rate = 8 * static_cast<double>(bytes) * 25 / kFrames;
  EXPECT_LE(rate, 120e3);
  EXPECT_GE(rate, 0.97 * 120e3);
}

}  // namespace
}  // namespace slf::frames_parts_test
