// SPDX-License-Identifier: Apache-2.0
// Cells of a frame decoded before, found by brute force too.
#include "geometry/reference_walk.h"

#include <gtest/gtest.h>

#include <set>

#include "tests/codec/field_support.h"

namespace slf::reference_cells_test {
namespace {

struct Brute {
  std::set<Voxel> cells;

  Window window(const Voxel& first) const {
    Window window = 0;
    for (std::int32_t i = 0; i < 64; ++i)
      if (cells.count({first[0] + (i & 3), first[1] + (i >> 2 & 3), first[2] + (i >> 4)}) != 0)
        window |= Window{1} << i;
    return window;
  }
};

Brute cells_at(const std::vector<Voxel>& voxels, int below) {
  Brute brute;
  for (const Voxel& v : voxels) brute.cells.insert({v[0] >> below, v[1] >> below, v[2] >> below});
  return brute;
}

/// Around cells that are there, and anywhere, beyond the grid too.
std::vector<Voxel> places(const std::vector<Voxel>& voxels, int below, int level) {
  std::mt19937 random(3);
  const auto any = [&](std::int32_t from, std::int32_t size) {
    return from + static_cast<std::int32_t>(random() % static_cast<std::uint32_t>(size));
  };
  std::vector<Voxel> all;
  for (int i = 0; i < 3000; ++i) {
    const Voxel& v = voxels[random() % voxels.size()];
    all.push_back(
        {(v[0] >> below) + any(-5, 8), (v[1] >> below) + any(-5, 8), (v[2] >> below) + any(-5, 8)});
    const std::int32_t size = (1 << level) + 20;
    all.push_back({any(-10, size), any(-10, size), any(-10, size)});
  }
  for (const std::int32_t far : {-(1 << 22), -(1 << 21), -4, -1, 1 << 21, (1 << 21) + 3, 1 << 23})
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Voxel v = voxels.front();
      v[axis] = far;
      all.push_back(v);
    }
  return all;
}

class ReferenceCellsTest : public testing::TestWithParam<test::NamedCloud> {};

TEST_P(ReferenceCellsTest, WindowsAndPlacesAreThoseOfBruteForceAtEveryLevel) {
  const auto& [name, bits, voxels] = GetParam();
  const auto codes = test::codes(voxels);
  const ReferenceCells cells(codes, bits);
  ASSERT_EQ(cells.levels(), bits);
  for (int level = 0; level <= bits; ++level) {
    const Brute brute = cells_at(voxels, bits - level);
    ASSERT_EQ(cells.codes(level).size(), brute.cells.size());
    ReferenceWalk walk(cells.level(level));
    for (const Voxel& place : places(voxels, bits - level, level)) {
      ASSERT_EQ(walk.window(place), brute.window(place))
          << level << ": " << place[0] << ' ' << place[1] << ' ' << place[2];
      const std::uint32_t found = walk.find(place);
      if (brute.cells.count(place) == 0) {
        ASSERT_EQ(found, ReferenceLevel::kNone);
      } else {
        ASSERT_LT(found, cells.codes(level).size());
        ASSERT_EQ(cells.codes(level)[found], morton(place));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Clouds, ReferenceCellsTest,
                         testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_12_2_ReferenceCells, NoFrameHasNone) { EXPECT_EQ(ReferenceCells().levels(), -1); }

}  // namespace
}  // namespace slf::reference_cells_test
