// SPDX-License-Identifier: Apache-2.0
// Points of the reference that move one by one: what is coded comes back, what is damaged is an
// error. Spec 7.13, 8.12.7.
#include <random>

#include "attributes/moved_means.h"
#include "codec/decoder/frame_chain.h"
#include "codec/encoder/pack_frame.h"
#include "codec/frame_vectors.h"
#include "frames_edit.h"
#include "slf/truncate.h"

namespace slf::frames_moved_test {
namespace {

using namespace test;

constexpr std::uint32_t kFeatures = kReferenceContexts | kMovedPoints;

/// Points that lie apart and have nothing in common with those beside them.
LightField scattered(int frame, std::uint32_t seed = 3) {
  std::mt19937 random(seed);
  std::map<std::uint64_t, std::array<std::int32_t, 6>> points;
  for (int p = 0; p < 400; ++p) {
    std::array<std::int32_t, 6> values;
    for (auto& value : values) value = static_cast<std::int32_t>(random() % 4000) - 2000;
    const Voxel at{static_cast<std::int32_t>(random() % 50),
                   static_cast<std::int32_t>(random() % 60),
                   static_cast<std::int32_t>(random() % 60)};
    points[morton({at[0] + frame * (1 + p % 4), at[1] + frame, at[2]})] = values;
  }
  LightField field = make_field({}, kFrameBits, 2);
  for (const auto& [code, values] : points) {
    field.positions.push_back(from_morton(code));
    field.components.insert(field.components.end(), values.begin(), values.end());
  }
  return field;
}

/// Each point of the reference goes where one of the same values is now.
std::vector<PointMove> true_moves(const LightField& before, const LightField& now) {
  std::map<std::vector<std::int32_t>, Voxel> places;
  const auto values = [](const LightField& field, std::size_t p) {
    return std::vector<std::int32_t>(field.components.begin() + std::ptrdiff_t(6 * p),
                                     field.components.begin() + std::ptrdiff_t(6 * p + 6));
  };
  for (std::size_t p = 0; p < now.num_points(); ++p) places[values(now, p)] = now.positions[p];
  std::vector<PointMove> moves(before.num_points());
  for (std::size_t p = 0; p < moves.size(); ++p) {
    const auto found = places.find(values(before, p));
    for (std::size_t k = 0; k < 3 && found != places.end(); ++k)
      moves[p][k] = found->second[k] - before.positions[p][k];
  }
  return moves;
}

CodingParameters moved_parameters() {
  CodingParameters p = small_parameters();
  p.geometry_level_ends = {3, 6};
  p.coefficient_level_ends = {2, 6};
  p.base_levels = 0;
  p.index = false;
  return p;
}

/// An intra frame and one whose points move, or that an affine motion predicts.
std::vector<Bytes> two_frames(bool moved) {
  const CodingParameters parameters = moved_parameters();
  GroupCoding group;
  group.features = kFeatures;
  FrameHeader header;
  const LightField before = scattered(0), now = scattered(1);
  std::vector<Bytes> frames{*pack_frame(before, parameters, &header, &group)};
  FrameChain chain;
  EXPECT_TRUE(chain.decode(frames[0], *read_frame(frames[0], 0), {}));
  header = {};
  header.frame_number = header.frame_predicted_flag = 1;
  header.frame_time = 1;
  header.motion.shift = {32, 16, 0};
  ChooseMoves choose;
  if (moved)
    choose = [&](auto, auto) {
      std::vector<PointMove> moves = true_moves(before, now);
      for (PointMove& move : moves) move = {move[0] - 2, move[1] - 1, move[2]};
      return moves;
    };
  frames.push_back(*pack_predicted(now, parameters, group, chain.state(), header, choose));
  return frames;
}

TEST(Spec_8_12_7_MovedPoints, ForetellPointsThatHaveNothingInCommonWithOthers) {
  EXPECT_LT(4 * two_frames(true)[1].size(), two_frames(false)[1].size());
}

TEST(Spec_8_12_7_MovedPoints, FramesOfThemAreDecoded) {
  const Bytes stream = joined(two_frames(true));
  FrameDecoder decoder = opened(stream);
  const LightField field = decoded_frame(decoder, 1), given = scattered(1);
  EXPECT_EQ(field.positions, given.positions);
  for (std::size_t i = 0; i < field.components.size(); ++i)
    EXPECT_NEAR(field.components[i], given.components[i], 60);
}

/// Nodes of a level: what is asked for is the same, whatever is needed beside it.
TEST(Spec_8_12_7_MovedPoints, CoarseFramesHaveTheNodesOfTheWhole) {
  const Bytes stream = joined(two_frames(true));
  for (const int levels : {1, 3, 5}) {
    DecodeOptions options;
    options.levels = levels;
    FrameDecoder coarse = opened(stream, options), fine = opened(stream);
    const LightField few = decoded_frame(coarse, 1), all = decoded_frame(fine, 1);
    std::map<std::uint64_t, std::pair<double, int>> sums;
    for (std::size_t p = 0; p < all.num_points(); ++p) {
      auto& [sum, count] = sums[morton(all.positions[p]) >> 3 * (kFrameBits - levels)];
      sum += all.components[6 * p];
      ++count;
    }
    ASSERT_EQ(few.num_points(), sums.size());
    for (std::size_t p = 0; p < few.num_points(); ++p) {
      const auto& [sum, count] = sums.at(morton(few.positions[p]));
      EXPECT_NEAR(few.components[6 * p], sum / count, 3) << levels << " " << p;
    }
  }
}

TEST(Spec_8_12_7_MovedPoints, LevelsAreNotCutOutOfThem) {
  const Bytes stream = joined(two_frames(true));
  DecodeOptions levels, groups;
  levels.levels = 3;
  groups.groups = 1;
  const auto cut = truncate(stream, levels);
  ASSERT_FALSE(cut);
  EXPECT_EQ(cut.error().code, Errc::kInvalidArgument);
  const auto fewer = truncate(stream, groups);
  ASSERT_TRUE(fewer);
  FrameDecoder decoder = opened(*fewer);
  EXPECT_EQ(decoded_frame(decoder, 1).positions, scattered(1).positions);
}

TEST(Spec_8_12_7_MovedPoints, LevelsAreCutOutOfAFrameThatNoOtherNeeds) {
  const Bytes stream = joined(two_frames(true));
  for (int levels = 1; levels < kFrameBits; ++levels) {
    DecodeOptions few;
    few.levels = levels;
    const auto cut = truncate_frames(stream, 0, 0, few);
    ASSERT_TRUE(cut) << to_string(cut.error());
    EXPECT_LT(cut->size(), two_frames(true)[0].size());
    FrameDecoder whole = opened(stream, few), decoder = opened(*cut);
    const LightField expected = decoded_frame(whole, 0), field = decoded_frame(decoder, 0);
    EXPECT_EQ(field.positions, expected.positions);
    EXPECT_EQ(field.components, expected.components);
    // A predicted frame behind it is refused, not drawn wrong.
    Bytes with_next = *cut;
    const Bytes next = two_frames(true)[1];
    with_next.insert(with_next.end(), next.begin(), next.end());
    FrameDecoder broken = opened(with_next);
    EXPECT_FALSE(broken.decode(1));
  }
}

TEST(Spec_8_12_7_MovedPoints, MemoryForThemIsCountedBeforeItIsTaken) {
  const Bytes stream = joined(two_frames(true));
  DecodeOptions options;
  options.limits.max_memory = 30'000'000;
  std::uint64_t least = 0;
  for (std::uint64_t memory = 1 << 16; memory < 40'000'000; memory += memory / 8) {
    options.limits.max_memory = memory;
    const auto error = decode_all(stream, options);
    if (!error) break;
    EXPECT_EQ(error->code, Errc::kLimitExceeded) << memory;
    least = memory;
  }
  EXPECT_GT(least, 400u * 100);
}

TEST(Spec_8_12_7_Hazards, EveryFlippedByteBehindASoundCrcIsAnErrorOrALightField) {
  const auto frames = two_frames(true);
  expect_flips_are_harmless(joined(frames), frames[0].size());
}

TEST(Spec_7_13_VectorsOfPoints, ComeBack) {
  std::mt19937 random(9);
  std::vector<std::uint64_t> codes(3000);
  for (std::size_t p = 0; p < codes.size(); ++p) codes[p] = 7 * p;
  const ReferenceCells cells(codes, 6);
  for (const int kind : {0, 1, 2}) {
    FrameHeader header;
    header.moves_points = true;
    header.moves.resize(codes.size());
    for (PointMove& move : header.moves) {
      if (kind == 0 || random() % 3 == 0) continue;
      const std::int32_t most = kind == 2 ? 1 << 21 : 40;
      for (std::size_t k = 0; k < 3; ++k)
        move[k] = static_cast<std::int32_t>(random() % static_cast<unsigned>(2 * most + 1)) - most;
    }
    const Bytes codeword = write_vectors(cells, 6, header);
    FrameHeader back;
    back.moves_points = true;
    const auto read = read_vectors(codeword, cells, 6, back);
    ASSERT_TRUE(read) << kind << to_string(read.error());
    EXPECT_EQ(back.moves, header.moves) << kind;
    for (std::size_t size = 0; size + 5 < codeword.size(); size += 1 + codeword.size() / 40) {
      FrameHeader cut;
      cut.moves_points = true;
      EXPECT_FALSE(read_vectors(std::span(codeword).first(size), cells, 6, cut)) << size;
    }
  }
}

TEST(Spec_8_12_7_Means, AreThoseOfThePointsInANode) {
  std::mt19937 random(4);
  std::vector<std::uint64_t> codes;
  for (std::uint64_t code = 0; code < 64; code += 3) codes.push_back(code);
  std::vector<PointMove> moves(codes.size());
  std::vector<std::int32_t> values(2 * codes.size());
  for (PointMove& move : moves) {
    move = {int(random() % 5) - 2, int(random() % 9) - 4, 0};
  }
  for (auto& value : values) value = static_cast<std::int32_t>(random() % 1001) - 500;
  const MovedPoints moved = move_points(codes, moves, {}, 2);
  const LevelMeans means = moved_means(moved, values, 2, 2);
  ASSERT_EQ(means.size(), 3u);
  for (int level = 0; level <= 2; ++level) {
    std::map<std::uint64_t, std::array<double, 3>> sums;
    for (std::size_t m = 0; m < moved.codes.size(); ++m) {
      auto& sum = sums[moved.codes[m] >> 3 * (2 - level)];
      sum[0] += values[2 * moved.from[m]];
      sum[1] += values[2 * moved.from[m] + 1];
      ++sum[2];
    }
    const auto& of_level = means[static_cast<std::size_t>(level)];
    ASSERT_EQ(of_level.size(), 2 * sums.size());
    std::size_t i = 0;
    for (const auto& [code, sum] : sums)
      for (const double of_plane : {sum[0], sum[1]})
        EXPECT_EQ(of_level[i++], std::floor(of_plane / sum[2] + 0.5)) << level;
  }
}

}  // namespace
}  // namespace slf::frames_moved_test
