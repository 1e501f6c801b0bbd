// SPDX-License-Identifier: Apache-2.0
// Frames without points: coded, listed, decoded, cut, joined with others, and damaged. Spec 7.13.
#include "slf/frame_reader.h"
#include "slf/truncate.h"

#include "frames_support.h"
#include "slf/decoder.h"

namespace slf::frames_empty_test {
namespace {

using namespace test;

constexpr std::array kEmpty = {true, false, false, true, false, false, true, true};

/// Frames of which some have no points.
std::vector<LightField> fields() {
  std::vector<LightField> all = fields_of(Moves::kShift, static_cast<int>(kEmpty.size()));
  for (std::size_t t = 0; t < all.size(); ++t)
    if (kEmpty[t]) {
      all[t].positions.clear();
      all[t].components.clear();
    }
  return all;
}

std::vector<Bytes> coded(int group = 16) {
  return coded_frames(fields(), frame_parameters(1), group);
}

/// Signature, type, major.
int minor_of(const Bytes& intra) { return intra[10]; }

TEST(Spec_7_13_EmptyFrames, DecodeToNoPointsAndTheOthersToTheirs) {
  const auto given = fields();
  const Bytes stream = joined(coded());
  FrameDecoder decoder = opened(stream);
  ASSERT_EQ(decoder.frames().size(), given.size());
  for (const std::size_t t : {7u, 6u, 5u, 4u, 3u, 2u, 1u, 0u, 3u, 4u}) {
    const LightField field = decoded_frame(decoder, t);
    EXPECT_EQ(field.positions, given[t].positions) << t;
    EXPECT_FALSE(field.partial) << t;
    EXPECT_EQ(field.header.num_functions, kFrameFunctions) << t;
    EXPECT_EQ(field.header.grid.bits, kFrameBits) << t;
  }
}

TEST(Spec_7_13_EmptyFrames, AreGroupsOfTheirOwnAndSoIsWhatFollows) {
  for (const int group : {2, 3, 16}) {
    const auto infos = *list_frames(joined(coded(group)));
    for (std::size_t t = 0; t < infos.size(); ++t) {
      const bool begins =
          t % static_cast<std::size_t>(group) == 0 || kEmpty[t] || (t > 0 && kEmpty[t - 1]);
      EXPECT_EQ(infos[t].predicted, !begins) << t << " of groups of " << group;
    }
  }
}

TEST(Spec_7_1_2_EmptyFrames, TheirGroupsAloneSayThatTheyAreOfALaterVersion) {
  const auto frames = coded();
  for (std::size_t t = 0; t < frames.size(); ++t)
    if (frames[t][0] == kSignature[0]) {
      EXPECT_EQ(minor_of(frames[t]) == 2, kEmpty[t]) << t;
    }
  CodingParameters plain = frame_parameters(8);
  plain.reference_contexts = false;
  EXPECT_EQ(minor_of(coded_frames(fields(), plain)[1]), 0);
}

TEST(Spec_7_13_EmptyFrames, ArriveInPiecesAndAreDecodedInAnyOrder) {
  const Bytes stream = joined(coded());
  FrameDecoder whole = opened(stream);
  for (const std::size_t piece : {std::size_t{1}, std::size_t{57}, stream.size()}) {
    FrameReader reader = *FrameReader::open();
    for (std::size_t at = 0; at < stream.size(); at += piece)
      ASSERT_TRUE(reader.push(std::span(stream).subspan(at, std::min(piece, stream.size() - at))));
    ASSERT_TRUE(reader.finish());
    ASSERT_EQ(reader.frames().size(), kEmpty.size());
    for (const std::size_t t : {3u, 0u, 7u, 5u}) {
      const auto field = reader.decode(t);
      ASSERT_TRUE(field) << to_string(field.error());
      expect_same(*field, decoded_frame(whole, t));
    }
  }
}

TEST(Spec_7_13_EmptyFrames, InfoAndOneLightFieldAreOfTheFirst) {
  const Bytes stream = joined(coded());
  const auto info = read_info(stream);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->num_points, 0u);
  EXPECT_TRUE(info->complete);
  const auto field = decode(stream);
  ASSERT_TRUE(field) << to_string(field.error());
  EXPECT_EQ(field->num_points(), 0u);
}

TEST(Spec_7_13_EmptyFrames, AskedForInPartGiveNothingOnTheCoarserGrid) {
  const Bytes stream = joined(coded());
  for (int levels = 1; levels <= kFrameBits; ++levels) {
    DecodeOptions options;
    options.levels = levels;
    options.groups = 1;
    options.region = VoxelBox{{0, 0, 0}, {20, 20, 20}};
    FrameDecoder decoder = opened(stream, options);
    const LightField field = decoded_frame(decoder, 3);
    EXPECT_EQ(field.num_points(), 0u);
    EXPECT_EQ(field.header.grid.bits, levels);
  }
}

TEST(Spec_7_13_EmptyFrames, StayWhenFramesAndLevelsAreLeftOut) {
  const Bytes stream = joined(coded());
  DecodeOptions options;
  options.levels = 4;
  options.groups = 2;
  FrameDecoder whole = opened(stream, options);
  const auto cut = truncate_frames(stream, 2, 7, options);
  ASSERT_TRUE(cut) << to_string(cut.error());
  FrameDecoder decoder = opened(*cut);
  ASSERT_EQ(decoder.frames().size(), 7u);  // from 1 on, which 2 is predicted from
  for (std::size_t t = 0; t < 7; ++t)
    EXPECT_EQ(decoded_frame(decoder, t).positions, decoded_frame(whole, t + 1).positions) << t;
  const auto last = truncate_frames(*cut, 5, 6);  // again: the cut of a cut
  ASSERT_TRUE(last) << to_string(last.error());
  EXPECT_EQ(list_frames(*last)->size(), 2u);
}

TEST(Spec_7_13_EmptyFrames, WithoutTheEndUnitTheyArePartial) {
  const Bytes frame = coded()[0];
  const auto units = *split_frames(frame);
  const Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(units[0].unit.offset +
                                                                             units[0].unit.bytes));
  const auto field = decode(cut);
  ASSERT_TRUE(field) << to_string(field.error());
  EXPECT_TRUE(field->partial);
  EXPECT_EQ(field->num_points(), 0u);
}

TEST(Spec_7_13_EmptyFrames, EveryTruncationAndChangedByteIsAValueOrAnError) {
  const Bytes frame = coded()[0];
  for (std::size_t size = 0; size < frame.size(); ++size) {
    const Bytes cut(frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size));
    const auto field = decode(cut);
    EXPECT_TRUE(!field || field->partial) << size;
  }
  for (std::size_t at = 0; at < frame.size(); ++at)
    for (int bit = 0; bit < 8; ++bit) {
      Bytes changed = frame;
      changed[at] ^= static_cast<std::uint8_t>(1 << bit);
      const auto field = decode(changed);  // a minor version is not in any checksum of ours
      EXPECT_FALSE(field) << at << ", " << bit;
    }
}

TEST(Spec_7_13_EmptyFrames, NormalsAndThoseWithoutFunctionsAreEmptyToo) {
  for (const int functions : {0, kFrameFunctions}) {
    std::vector<LightField> some = fields_of(Moves::kTurn, 3, functions);
    for (LightField& field : some) field = with_normals(std::move(field));
    some[1].positions.clear();
    some[1].components.clear();
    some[1].normals.octahedral.clear();
    CodingParameters p = frame_parameters(4, functions);
    const Bytes stream = joined(coded_frames(some, p));
    FrameDecoder decoder = opened(stream);
    EXPECT_EQ(decoded_frame(decoder, 1).num_points(), 0u);
    EXPECT_EQ(decoded_frame(decoder, 1).normals.bits, 5);
    EXPECT_EQ(decoded_frame(decoder, 2).positions, some[2].positions);
  }
}

TEST(Spec_7_13_EmptyFrames, EmptyFramesWithAnotherHeaderAreRefused) {
  FrameEncoder encoder(frame_parameters(8));
  ASSERT_TRUE(encoder.add(frame_of(Moves::kTurn, 0), 0));
  LightField other = make_field({}, kFrameBits - 1, kFrameFunctions);
  EXPECT_FALSE(encoder.add(other, 1));
  other = make_field({}, kFrameBits, kFrameFunctions);
  other.components.assign(12, 1);  // of a point that is not there
  EXPECT_FALSE(encoder.add(other, 1));
}

TEST(Spec_7_3_Slices, ALightFieldThatDoesNotMoveHasPoints) {
  EXPECT_FALSE(pack(make_field({}, kFrameBits, kFrameFunctions), frame_parameters(8)));
}

}  // namespace
}  // namespace slf::frames_empty_test
