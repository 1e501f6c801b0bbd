// SPDX-License-Identifier: Apache-2.0
// Frames with less in them: what is left decodes as it did. Spec 7.13, 8.9.
#include "frames_support.h"
#include "slf/truncate.h"

namespace slf::frames_truncate_test {
namespace {

using namespace test;

/// Frames of a cut stream are those of the stream, asked for the same.
void expect_cut(const Bytes& cut, const Bytes& stream, const DecodeOptions& options,
                std::size_t first = 0) {
  FrameDecoder after = opened(cut), before = opened(stream, options);
  for (std::size_t t = 0; t < after.frames().size(); ++t) {
    SCOPED_TRACE(t);
    EXPECT_EQ(after.frames()[t].number, before.frames()[first + t].number);
    EXPECT_EQ(after.frames()[t].time, before.frames()[first + t].time);
    const LightField a = decoded_frame(after, t), b = decoded_frame(before, first + t);
    EXPECT_EQ(a.positions, b.positions);
    EXPECT_EQ(a.components, b.components);
    EXPECT_EQ(a.normals.octahedral, b.normals.octahedral);
  }
}

class TruncatedFrames : public testing::TestWithParam<Moves> {
 protected:
  Bytes stream_ = joined(coded_frames(fields_of(GetParam(), 6), frame_parameters(12), 3));
};

TEST_P(TruncatedFrames, LevelsAndGroupsAreThoseAskedFor) {
  for (const int levels : {0, 1, 2, 3, 4, 6})
    for (const int groups : {0, 1, 2}) {
      DecodeOptions options;
      options.levels = levels;
      options.groups = groups;
      const auto cut = truncate(stream_, options);
      ASSERT_TRUE(cut) << to_string(cut.error());
      SCOPED_TRACE(std::to_string(levels) + " levels " + std::to_string(groups) + " groups");
      EXPECT_EQ(opened(*cut).frames().size(), 6u);
      EXPECT_LE(cut->size(), stream_.size() + 6);
      expect_cut(*cut, stream_, options);
      EXPECT_EQ(*truncate(*cut, options), *cut);
    }
}

TEST_P(TruncatedFrames, NothingLeftOutIsTheSameStream) {
  EXPECT_EQ(*truncate(stream_, {}), stream_);
}

TEST_P(TruncatedFrames, KeepThoseOfTheGroupBefore) {
  const std::size_t from_group[] = {0, 0, 0, 3, 3, 3};
  for (std::size_t first = 0; first < 6; ++first)
    for (std::size_t last = first; last < 8; ++last) {
      const auto cut = truncate_frames(stream_, first, last);
      ASSERT_TRUE(cut);
      EXPECT_EQ(opened(*cut).frames().size(),
                std::min<std::size_t>(last, 5) + 1 - from_group[first]);
      expect_cut(*cut, stream_, {}, from_group[first]);
    }
  EXPECT_FALSE(truncate_frames(stream_, 6, 6));
  EXPECT_FALSE(truncate_frames(stream_, 2, 1));
}

TEST_P(TruncatedFrames, WithinSoManyBytesAreWholeFrames) {
  FrameDecoder whole = opened(stream_);
  for (std::size_t kept = 1; kept <= 6; ++kept) {
    DecodeOptions options;
    const FrameInfo& last = whole.frames()[kept - 1];
    options.max_bytes = last.offset + last.bytes;
    EXPECT_EQ(opened(*truncate(stream_, options)).frames().size(), kept);
    --options.max_bytes;
    const auto fewer = truncate(stream_, options);
    EXPECT_EQ(fewer ? opened(*fewer).frames().size() : 0, kept - 1);
  }
}

TEST_P(TruncatedFrames, APartialFrameStaysPartial) {
  DecodeOptions options;
  options.groups = 2;
  const std::vector<FrameInfo> infos = *list_frames(stream_);
  for (const FrameInfo& info : infos) {
    const auto frame = static_cast<std::size_t>(info.number);
    int partial = 0;  // streams that end between two units
    for (std::size_t less = 1; less < 12; ++less) {
      const auto end = static_cast<std::ptrdiff_t>(info.offset + info.bytes - less);
      const Bytes some(stream_.begin(), stream_.begin() + end);
      FrameDecoder decoder = opened(some);
      if (!decoder.decode(frame)) continue;
      const auto cut = truncate(some, options);
      ASSERT_TRUE(cut) << to_string(cut.error());
      expect_cut(*cut, some, options);
      FrameDecoder after = opened(*cut);
      EXPECT_TRUE(decoded_frame(after, frame).partial);
      ++partial;
    }
    EXPECT_EQ(partial, 1) << frame;
  }
}

TEST_P(TruncatedFrames, ARegionIsRefused) {
  DecodeOptions options;
  options.region.emplace();
  EXPECT_EQ(truncate(stream_, options).error().code, Errc::kInvalidArgument);
}

INSTANTIATE_TEST_SUITE_P(Spec_7_13, TruncatedFrames,
                         testing::Values(Moves::kNothing, Moves::kTurn, Moves::kBend,
                                         Moves::kChance, Moves::kAppears),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace slf::frames_truncate_test
