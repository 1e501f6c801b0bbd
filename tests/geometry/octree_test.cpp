// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "geometry/encoder/octree_encoder.h"
#include "geometry/octree_decoder.h"
#include "tests/codec/field_support.h"

namespace slf::octree_test {
namespace {

using test::codes;

TEST(Spec_6_2_Morton, InterleavesWithXLeastSignificant) {
  EXPECT_EQ(morton({1, 0, 0}), 1u);
  EXPECT_EQ(morton({0, 1, 0}), 2u);
  EXPECT_EQ(morton({0, 0, 1}), 4u);
  EXPECT_EQ(morton({3, 0, 0}), 9u);
  const Voxel far = {(1 << 21) - 1, 0x155555, 0x0AAAAA};
  EXPECT_EQ(from_morton(morton(far)), far);
  EXPECT_EQ(morton({(1 << 21) - 1, (1 << 21) - 1, (1 << 21) - 1}), (std::uint64_t{1} << 63) - 1);
}

TEST(Spec_8_4_1_Neighbours, AreThoseOfTheGrid) {
  // The levels of a random cloud against a search by coordinates.
  const auto voxels = test::random_cloud(700, 4, 3);
  OctreeLevel nodes = octree_root();
  for (int level = 0; level < 4; ++level) {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      nodes.occupancy[n] = 0;
      for (const Voxel& v : voxels)
        if (morton(v) >> (3 * (4 - level)) == nodes.morton[n])
          nodes.occupancy[n] = static_cast<std::uint8_t>(
              nodes.occupancy[n] | 1u << (morton(v) >> (3 * (3 - level)) & 7));
    }
    nodes = octree_children(nodes, true);
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      const Voxel at = from_morton(nodes.morton[n]);
      for (int dz = -1; dz <= 1; ++dz)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const Voxel to = {at[0] + dx, at[1] + dy, at[2] + dz};
            std::int32_t expected = -1;
            for (std::size_t m = 0; m < nodes.size(); ++m)
              if (from_morton(nodes.morton[m]) == to) expected = static_cast<std::int32_t>(m);
            const auto d = static_cast<std::size_t>(direction_index(dx, dy, dz));
            if (d == kSelf) continue;
            ASSERT_EQ(nodes.around[n].directions >> d & 1u, expected < 0 ? 0u : 1u);
            if (expected < 0) continue;
            ASSERT_EQ(nodes.neighbour(n, d), static_cast<std::uint32_t>(expected));
          }
    }
  }
}

class OctreeTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(OctreeTest, EveryRangeOfLevelsDecodesToItsNodes) {
  const auto& [name, bits, voxels] = GetParam();
  const auto morton_codes = codes(voxels);
  for (const std::vector<int>& ends :
       {std::vector<int>{bits}, std::vector<int>{(bits + 1) / 2, bits}}) {
    const auto payloads = encode_octree(morton_codes, bits, ends);
    ASSERT_EQ(payloads.size(), ends.size());
    OctreeDecoder decoder(bits, voxels.size(), OccupancyStates(voxels.size()));
    for (std::size_t i = 0; i < ends.size(); ++i) {
      ASSERT_TRUE(decoder.decode(payloads[i], ends[i]));
      std::vector<std::uint64_t> nodes;
      for (const std::uint64_t code : morton_codes)
        if (nodes.empty() || nodes.back() != code >> (3 * (bits - ends[i])))
          nodes.push_back(code >> (3 * (bits - ends[i])));
      EXPECT_EQ(decoder.morton(), nodes);
    }
  }
}

TEST_P(OctreeTest, ALevelFromItsCellsAloneIsThatOfTheWalkDown) {
  const auto& [name, bits, voxels] = GetParam();
  const auto points = codes(voxels);
  for (int level = 0; level < bits; ++level) {
    const auto cells = test::cells_of(points, bits - level);
    const OctreeLevel found = octree_level(cells, level);
    EXPECT_EQ(found.morton, cells);
    for (std::size_t n = 0; n < cells.size(); ++n)
      for (std::size_t d = 0; d < 27; ++d)
        if (found.around[n].directions >> d & 1u) {
          const Voxel at = from_morton(cells[n]), to = from_morton(cells[found.neighbour(n, d)]);
          const auto direction = static_cast<int>(d);
          EXPECT_EQ(to, (Voxel{at[0] + direction % 3 - 1, at[1] + direction / 3 % 3 - 1,
                               at[2] + direction / 9 - 1}));
        }
  }
}

TEST_P(OctreeTest, SlicesOfCellsDecodeFromTheStatesOfTheBase) {
  const auto& [name, bits, voxels] = GetParam();
  const auto points = codes(voxels);
  for (const int base : {1, bits / 2, bits - 1}) {
    if (base < 1 || base >= bits) continue;
    const auto cells = test::cells_of(points, bits - base);
    const OccupancyStates fresh(points.size());
    OctreeEncoder base_encoder(cells, base, fresh);
    OctreeDecoder base_decoder(base, cells.size(), fresh);
    ASSERT_TRUE(base_decoder.decode(base_encoder.encode(base), base));
    ASSERT_EQ(base_decoder.morton(), cells);
    for (const auto& slice : test::slices_of(points, bits - base, 3)) {
      const auto own_cells = test::cells_of(slice.points, bits - base);
      OctreeEncoder encoder(slice.points, bits, base_encoder.states(), base);
      OctreeDecoder decoder(bits, slice.points.size(), base_decoder.states(), base, own_cells);
      for (int end = base + 1; end <= bits; ++end)
        ASSERT_TRUE(decoder.decode(encoder.encode(end), end));
      EXPECT_EQ(decoder.morton(), slice.points);
    }
  }
}

TEST_P(OctreeTest, ASliceOfAllCellsCostsWhatTheWholeTreeDoes) {
  const auto& [name, bits, voxels] = GetParam();
  const auto points = codes(voxels);
  for (int base = 1; base < bits; base += 2) {
    OctreeEncoder whole(points, bits, OccupancyStates(points.size()));
    whole.encode(base);
    OctreeEncoder slice(points, bits, whole.states(), base);
    EXPECT_EQ(slice.encode(bits), whole.encode(bits));
  }
}

TEST_P(OctreeTest, AUnitThatStartsFromCopiedStatesTakesTheSameDecisions) {
  const auto& [name, bits, voxels] = GetParam();
  if (bits < 3) GTEST_SKIP() << "too few levels";
  const auto points = codes(voxels);
  const OccupancyStates fresh(points.size());
  OctreeEncoder one(points, bits, fresh), other(points, bits, fresh);
  one.encode(1);
  const OccupancyStates after_first = one.states();
  one.encode(2);
  other.encode(1);
  other.start_from(one.states());  // of another time
  other.encode(2);
  other.start_from(after_first);
  OctreeEncoder third(points, bits, fresh);
  third.encode(2);
  third.start_from(after_first);
  EXPECT_EQ(other.encode(bits), third.encode(bits));
}

TEST_P(OctreeTest, MoreNodesThanAllowedAreRefused) {
  const auto& [name, bits, voxels] = GetParam();
  const std::vector<int> ends = {bits};
  const auto payloads = encode_octree(codes(voxels), bits, ends);
  OctreeDecoder decoder(bits, voxels.size() - 1, OccupancyStates(voxels.size()));
  EXPECT_FALSE(decoder.decode(payloads[0], bits));
}

TEST(Spec_8_4_Bounds, AnExhaustedCodewordEndsTheWorkNotTheUnit) {
  // What a codeword of a few bytes asks for is bounded, whatever number of points is announced.
  for (const int byte : {0x00, 0x55, 0xFF}) {
    const std::vector<std::uint8_t> payload(16, static_cast<std::uint8_t>(byte));
    constexpr std::uint64_t kPoints = std::uint64_t{1} << 22;
    OctreeDecoder decoder(21, kPoints, OccupancyStates(kPoints));
    const auto decoded = decoder.decode(payload, 21);
    ASSERT_FALSE(decoded);
    // 8.3.3: at most 16600 decisions a byte, of which a node of several children takes seven or
    // more.
    EXPECT_LT(decoder.morton().size(), std::size_t{8} * 16600 * 20 / 7);
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_4, OctreeTest, testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_4_Rate, AClosedSurfaceTakesLessThanABitAPoint) {
  const auto voxels = test::sphere_cloud(7);
  const std::vector<int> ends = {7};
  EXPECT_LT(8.0 * static_cast<double>(encode_octree(codes(voxels), 7, ends)[0].size()),
            1.0 * static_cast<double>(voxels.size()));
}

TEST(Spec_8_4_6_OnlyChild, OneThatSitsAlikeInEveryNodeTakesATenthOfABit) {
  std::vector<Voxel> apart = test::sphere_cloud(7);
  for (Voxel& v : apart)
    for (std::size_t axis = 0; axis < 3; ++axis) v[axis] = 2 * v[axis] + (axis != 1);
  const std::vector<int> ends = {7, 8};
  EXPECT_LT(80.0 * static_cast<double>(encode_octree(codes(apart), 8, ends)[1].size()),
            1.0 * static_cast<double>(apart.size()));
}

}  // namespace
}  // namespace slf::octree_test
