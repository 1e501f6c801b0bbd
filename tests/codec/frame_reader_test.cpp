// SPDX-License-Identifier: Apache-2.0
// Frames of a stream that comes in pieces: the same light fields, whatever the pieces.
// Spec 7.13, 8.12.
#include "slf/frame_reader.h"

#include <numeric>

#include "frames_edit.h"

namespace slf::frame_reader_test {
namespace {

using namespace test;

FrameReader reader(const DecodeOptions& options = {}) { return *FrameReader::open(options); }

void push_in_pieces(FrameReader& to, const Bytes& stream, std::size_t piece, std::size_t from = 0) {
  for (std::size_t at = from; at < stream.size(); at += piece) {
    const auto rest = std::span(stream).subspan(at);
    const auto pushed = to.push(rest.first(std::min(piece, rest.size())));
    ASSERT_TRUE(pushed) << to_string(pushed.error());
  }
}

FrameReader read_whole(const Bytes& stream, std::size_t piece = 100) {
  FrameReader read = reader();
  push_in_pieces(read, stream, piece);
  EXPECT_TRUE(read.finish());
  return read;
}

LightField decoded(FrameReader& from, std::size_t frame) {
  auto field = from.decode(frame);
  EXPECT_TRUE(field) << frame << ' ' << (field ? "" : to_string(field.error()));
  return field ? *field : LightField{};
}

std::size_t bytes_of(const std::vector<Bytes>& frames, std::size_t count) {
  return std::accumulate(frames.begin(), frames.begin() + static_cast<std::ptrdiff_t>(count),
                         std::size_t{0},
                         [](std::size_t sum, const Bytes& f) { return sum + f.size(); });
}

TEST(Spec_7_13_Arrival, FramesAreThoseOfTheWholeStreamWhateverThePieces) {
  const Bytes stream = joined(small_frames());
  FrameDecoder whole = opened(stream);
  for (const std::size_t piece :
       {std::size_t{1}, std::size_t{7}, std::size_t{1000}, stream.size()}) {
    FrameReader read = read_whole(stream, piece);
    ASSERT_EQ(read.frames().size(), whole.frames().size()) << piece;
    for (std::size_t t = 0; t < read.frames().size(); ++t) {
      EXPECT_EQ(read.frames()[t].offset, whole.frames()[t].offset);
      EXPECT_EQ(read.frames()[t].bytes, whole.frames()[t].bytes);
      EXPECT_EQ(read.frames()[t].predicted, whole.frames()[t].predicted);
      EXPECT_EQ(read.frames()[t].time, whole.frames()[t].time);
      EXPECT_FALSE(read.frames()[t].lost);
    }
    for (const std::size_t t : {0u, 1u, 2u, 3u, 4u, 2u, 0u, 4u, 4u})
      expect_same(decoded(read, t), decoded_frame(whole, t));
  }
}

TEST(Spec_7_13_Arrival, AFrameIsListedAndDecodedWithItsLastByteAndNotBefore) {
  const auto frames = small_frames();
  const Bytes stream = joined(frames);
  FrameDecoder whole = opened(stream);
  FrameReader read = reader();
  for (std::size_t at = 0; at < stream.size(); ++at) {
    std::size_t arrived = 0;
    while (arrived < frames.size() && bytes_of(frames, arrived + 1) <= at) ++arrived;
    ASSERT_EQ(read.frames().size(), arrived) << at;
    ASSERT_TRUE(read.push(std::span(stream).subspan(at, 1)));
    if (read.frames().size() > arrived)
      expect_same(decoded(read, arrived), decoded_frame(whole, arrived));
  }
  EXPECT_EQ(read.frames().size(), frames.size());
}

TEST(Spec_7_13_Arrival, EveryTruncationListsWhatTheDecoderOfTheWholeLists) {
  const Bytes whole = joined(small_frames());
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
    FrameReader read = reader();
    push_in_pieces(read, cut, 50);
    const auto ended = read.finish();
    auto decoder = FrameDecoder::open(cut);
    ASSERT_EQ(static_cast<bool>(ended), static_cast<bool>(decoder)) << size;
    if (!decoder) continue;
    ASSERT_EQ(read.frames().size(), decoder->frames().size()) << size;
    const std::size_t last = read.frames().size() - 1;
    const auto here = read.decode(last), there = decoder->decode(last);
    ASSERT_EQ(static_cast<bool>(here), static_cast<bool>(there)) << size;
    if (here) {
      expect_same(*here, *there);
    } else {
      EXPECT_EQ(to_string(here.error()), to_string(there.error())) << size;
    }
  }
}

TEST(Spec_8_12_Arrival, ErrorsNameTheirPlaceInTheWholeStream) {
  auto f = small_frames();
  f[1][f[1].size() / 2] ^= 1;
  const Bytes stream = joined(f);
  FrameDecoder whole = opened(stream);
  FrameReader read = read_whole(stream);
  for (const std::size_t t : {1u, 2u, 1u})
    EXPECT_EQ(to_string(read.decode(t).error()), to_string(whole.decode(t).error()));
  for (const std::size_t t : {0u, 3u, 4u}) decoded(read, t);
}

TEST(Spec_7_13_Loss, AFrameUnitThatIsDamagedCostsItsGroupAndIsReported) {
  const auto f = small_frames();
  const Bytes sound = joined(f);
  FrameDecoder whole = opened(sound);
  Bytes stream = sound;
  stream[f[0].size() + 2] ^= 0x40;  // of the frame unit of frame 1
  for (const std::size_t piece : {std::size_t{3}, stream.size()}) {
    FrameReader read = read_whole(stream, piece);
    ASSERT_EQ(read.frames().size(), 4u);
    const FrameInfo& lost = read.frames()[1];
    EXPECT_TRUE(lost.lost);
    EXPECT_EQ(lost.number, 2u);
    EXPECT_EQ(lost.offset, f[0].size());
    EXPECT_EQ(lost.bytes, f[1].size() + f[2].size());
    EXPECT_GT(lost.time, read.frames()[0].time);
    EXPECT_LT(lost.time, read.frames()[2].time);
    const auto field = read.decode(1);
    ASSERT_FALSE(field);
    EXPECT_GE(field.error().bit_offset, 8 * f[0].size());
    expect_same(decoded(read, 0), decoded_frame(whole, 0));
    expect_same(decoded(read, 2), decoded_frame(whole, 3));
    expect_same(decoded(read, 3), decoded_frame(whole, 4));
  }
}

TEST(Spec_7_13_Loss, FramesThatAreMissingAreOneLostFrameBeforeTheNextIntraFrame) {
  const auto f = small_frames();
  FrameReader predicted = read_whole(joined({f[0], f[2], f[3], f[4]}));
  ASSERT_EQ(predicted.frames().size(), 4u);
  EXPECT_TRUE(predicted.frames()[1].lost);
  EXPECT_STREQ(predicted.decode(1).error().element, "frame_number");
  EXPECT_EQ(predicted.frames()[2].number, 3u);
  decoded(predicted, 3);
  FrameReader intra = read_whole(joined({f[0], f[1], f[3], f[4]}));
  ASSERT_EQ(intra.frames().size(), 5u);
  EXPECT_TRUE(intra.frames()[2].lost);
  EXPECT_EQ(intra.frames()[2].bytes, 0u);
  decoded(intra, 4);
}

TEST(Spec_7_13_Loss, EveryMissingByteIsReportedAndTheLaterGroupDecodes) {
  const auto f = small_frames();
  const Bytes sound = joined(f);
  FrameDecoder whole = opened(sound);
  const LightField last = decoded_frame(whole, 4);
  for (std::size_t at = f[0].size(); at < bytes_of(f, 3); ++at) {
    Bytes stream = sound;
    stream.erase(stream.begin() + static_cast<std::ptrdiff_t>(at));
    FrameReader read = read_whole(stream, 500);
    std::size_t errors = 0;
    for (std::size_t t = 0; t < read.frames().size(); ++t) errors += read.decode(t) ? 0 : 1;
    EXPECT_GE(errors, 1u) << at;
    ASSERT_EQ(read.frames().back().number, 4u) << at;
    expect_same(decoded(read, read.frames().size() - 1), last);
  }
}

TEST(Spec_7_13_Loss, WhatIsDamagedToTheEndIsOneLostFrame) {
  const auto f = small_frames();
  Bytes stream = joined({f[0], f[1], f[2]});
  stream[f[0].size()] ^= 0x20;
  FrameReader read = read_whole(stream);
  ASSERT_EQ(read.frames().size(), 2u);
  EXPECT_TRUE(read.frames()[1].lost);
  EXPECT_FALSE(read.decode(1));
  decoded(read, 0);
}

TEST(Spec_7_13_Loss, FramesWithinFramesAreNotCopiedOverAndOver) {
  const auto f = small_frames();
  Bytes nested;  // each says that it reaches far beyond the next
  constexpr std::uint32_t kCount = 2000;
  for (std::uint32_t i = 0; i < kCount; ++i) {
    Frame head = split(f[0]);
    head.resize(2);
    const Bytes one = joined_units(head, [&](FrameHeader& h) {
      h.frame_number = i;
      h.frame_time = i;
      h.frame_bytes = 1 << 18;
    });
    nested.insert(nested.end(), one.begin(), one.end());
  }
  nested.push_back(99);
  FrameReader read = read_whole(nested, 1 << 12);
  EXPECT_LT(read.held_bytes(), 4 * nested.size());
}

TEST(FrameReader, RefusesWhatIsNoStreamForGood) {
  FrameReader read = reader();
  const Bytes other{'P', 'N', 'G', 1, 2, 3};
  const auto refused = read.push(other);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, Errc::kNotSlf);
  EXPECT_EQ(read.push(joined(small_frames())).error().code, Errc::kNotSlf);
  EXPECT_EQ(read.finish().error().code, Errc::kNotSlf);
  FrameReader empty = reader();
  EXPECT_EQ(empty.finish().error().code, Errc::kTruncated);
  Bytes damaged = joined(small_frames());
  damaged[12] ^= 1;
  FrameReader first = reader();
  EXPECT_FALSE(first.push(damaged) && first.finish());
}

TEST(FrameReader, DropsGroupsAndReadsThemAgainFromAnyIntraFrame) {
  const auto f = small_frames();
  const Bytes stream = joined(f);
  FrameReader read = read_whole(stream);
  const LightField second = decoded(read, 1), last = decoded(read, 4);
  EXPECT_EQ(read.held_bytes(), stream.size());
  read.drop_before(4);
  EXPECT_EQ(read.held_bytes(), f[3].size() + f[4].size());
  EXPECT_EQ(read.decode(1).error().code, Errc::kUnreadable);
  expect_same(decoded(read, 4), last);
  EXPECT_FALSE(read.seek(1));
  EXPECT_FALSE(read.seek(5));
  ASSERT_TRUE(read.seek(0));
  EXPECT_EQ(read.held_bytes(), 0u);
  EXPECT_EQ(read.decode(4).error().code, Errc::kUnreadable);
  push_in_pieces(read, stream, 90);
  ASSERT_EQ(read.frames().size(), 5u);
  expect_same(decoded(read, 1), second);
  ASSERT_TRUE(read.seek(3));
  push_in_pieces(read, stream, 90, bytes_of(f, 3));
  expect_same(decoded(read, 4), last);
}

TEST(FrameReader, BytesOfAnotherStreamBehindASeekAreRefused) {
  const Bytes stream = joined(small_frames());
  FrameReader read = read_whole(stream);
  ASSERT_TRUE(read.seek(3));
  EXPECT_FALSE(read.push(stream));  // frame 0 in the place of frame 3
}

TEST(FrameReader, HoldsNoMoreThanItsLimit) {
  const auto f = small_frames();
  DecodeOptions options;
  options.limits.max_stream_bytes = bytes_of(f, 3) + 10;
  FrameReader read = reader(options);
  push_in_pieces(read, joined({f[0], f[1], f[2]}), 200);
  const auto pushed = read.push(f[3]);
  ASSERT_FALSE(pushed);
  EXPECT_EQ(pushed.error().code, Errc::kLimitExceeded);
  ASSERT_TRUE(read.push(std::span(f[3]).first(10)));
  EXPECT_FALSE(read.push(std::span(f[3]).subspan(10)));
  read.drop_before(2);  // of the same group: nothing goes
  EXPECT_FALSE(read.push(std::span(f[3]).subspan(10)));
  options.max_bytes = 1;
  EXPECT_EQ(FrameReader::open(options).error().code, Errc::kInvalidArgument);
}

TEST(FrameReader, TakesNothingAfterTheEnd) {
  FrameReader read = read_whole(joined(small_frames()));
  EXPECT_EQ(read.push({}).error().code, Errc::kInvalidArgument);
  EXPECT_EQ(read.decode(5).error().code, Errc::kInvalidArgument);
}

TEST(FrameReader, OtherOptionsAreThoseOfFramesDecodedFromThenOn) {
  const Bytes stream = joined(small_frames());
  DecodeOptions options;
  options.levels = 3;
  FrameReader read = read_whole(stream);
  FrameDecoder whole = opened(stream), coarse = opened(stream, options);
  expect_same(decoded(read, 1), decoded_frame(whole, 1));
  ASSERT_TRUE(read.set_options(options));
  expect_same(decoded(read, 2), decoded_frame(coarse, 2));
  ASSERT_TRUE(read.set_options({}));
  expect_same(decoded(read, 2), decoded_frame(whole, 2));
  options.max_bytes = 1;
  EXPECT_EQ(read.set_options(options).error().code, Errc::kInvalidArgument);
}

TEST(Spec_8_12_Arrival, FewerLevelsAreThoseOfTheWholeStream) {
  const Bytes stream = joined(small_frames());
  DecodeOptions options;
  options.levels = 3;
  options.groups = 1;
  FrameReader read = reader(options);
  push_in_pieces(read, stream, 300);
  FrameDecoder whole = opened(stream, options);
  for (std::size_t t = 0; t < 5; ++t) expect_same(decoded(read, t), decoded_frame(whole, t));
}

}  // namespace
}  // namespace slf::frame_reader_test
