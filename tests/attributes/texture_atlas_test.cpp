// SPDX-License-Identifier: Apache-2.0
// Where the points of a slice stand in its pictures. Spec 8.11.
#include "attributes/texture/atlas.h"

#include <gtest/gtest.h>

#include "attributes/texture/box_packing.h"
#include "attributes/texture/charts.h"
#include "attributes/texture/encoder/padding.h"
#include "tests/codec/field_support.h"

namespace slf::texture_atlas_test {
namespace {

using test::NamedCloud;

void expect_a_pixel_for_every_point(const Atlas& atlas, std::size_t points) {
  EXPECT_EQ(atlas.width % 8, 0);
  EXPECT_EQ(atlas.height % 8, 0);
  EXPECT_GE(std::min(atlas.width, atlas.height), 64);
  EXPECT_LE(std::max(atlas.width, atlas.height), 8192);
  ASSERT_EQ(atlas.pixel.size(), points);
  std::vector<bool> used(static_cast<std::size_t>(atlas.width * atlas.height));
  for (const std::uint32_t pixel : atlas.pixel) {
    ASSERT_LT(pixel, used.size());
    ASSERT_FALSE(used[pixel]) << "two points at " << pixel;
    used[pixel] = true;
  }
}

class TextureAtlas : public testing::TestWithParam<NamedCloud> {};

TEST_P(TextureAtlas, EveryPointHasAPixelOfItsOwn) {
  for (int cell_log2 = 0; cell_log2 <= kMostCellLog2; ++cell_log2) {
    const auto atlas = derive_atlas(test::codes(GetParam().voxels), GetParam().bits, cell_log2);
    ASSERT_TRUE(atlas);
    expect_a_pixel_for_every_point(*atlas, GetParam().voxels.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Spec_8_11, TextureAtlas, testing::ValuesIn(test::clouds_of_every_shape()),
                         [](const auto& cloud) { return cloud.param.name; });

TEST(Spec_8_11_3_Charts, APlaneIsOneChartAndKeepsItsShape) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::vector<Voxel> voxels;
    for (std::int32_t a = 0; a < 40; ++a)
      for (std::int32_t b = 0; b < 24; ++b) {
        Voxel v{};
        v[axis] = 11;
        v[(axis + 1) % 3] = 5 + a;
        v[(axis + 2) % 3] = 9 + b;
        voxels.push_back(v);
      }
    voxels = test::sorted_distinct(voxels);
    const auto atlas = derive_atlas(test::codes(voxels), 6, 0);
    ASSERT_TRUE(atlas);
    EXPECT_EQ(atlas->num_charts, 1u);
    EXPECT_EQ(atlas->num_loose, 0u);
    for (std::size_t p = 0; p < voxels.size(); ++p) {  // lying: the longer side is x
      EXPECT_EQ(atlas->pixel[p] % 64, static_cast<std::uint32_t>(voxels[p][(axis + 1) % 3] - 5));
      EXPECT_EQ(atlas->pixel[p] / 64, static_cast<std::uint32_t>(voxels[p][(axis + 2) % 3] - 9));
    }
  }
}

TEST(Spec_8_11_3_Charts, ABoxStaysWithin512Pixels) {
  std::vector<Voxel> voxels;
  for (std::int32_t x = 0; x < 1500; ++x)
    for (std::int32_t y = 0; y < 8; ++y) voxels.push_back({x, y, 3});
  const auto atlas = derive_atlas(test::codes(test::sorted_distinct(voxels)), 11, 0);
  ASSERT_TRUE(atlas);
  EXPECT_EQ(atlas->num_charts, 3u);
  expect_a_pixel_for_every_point(*atlas, voxels.size());
}

TEST(Spec_8_11_1_Cells, PointsTwoApartHoldTogetherInCellsOfTwo) {
  std::vector<Voxel> voxels;
  for (std::int32_t x = 0; x < 64; x += 2)
    for (std::int32_t y = 0; y < 64; y += 2) voxels.push_back({x, y, 31});
  const auto codes = test::codes(test::sorted_distinct(voxels));
  EXPECT_EQ(derive_atlas(codes, 6, 0)->num_loose, voxels.size());
  EXPECT_EQ(derive_atlas(codes, 6, 1)->num_loose, 0u);
  EXPECT_EQ(derive_atlas(codes, 6, 2)->num_loose, voxels.size() * 3 / 4);
}

/// Geometry made to hurt: the atlas stays within 8 pixels a point and a row of tiles.
TEST(Spec_8_11_Hazards, HostileCloudsGiveBoundedAtlases) {
  std::vector<NamedCloud> clouds = {{"random", 21, test::random_cloud(1 << 20, 21, 3)},
                                    {"dense noise", 7, test::random_cloud(1 << 20, 7, 4)},
                                    {"cube", 7, {}},
                                    {"diagonal", 16, {}},
                                    {"patches", 12, {}},
                                    {"sticks", 12, {}}};
  for (std::int32_t z = 0; z < 100; ++z)
    for (std::int32_t y = 0; y < 100; ++y)
      for (std::int32_t x = 0; x < 100; ++x) clouds[2].voxels.push_back({x, y, z});
  for (std::int32_t i = 0; i < 1 << 16; ++i) clouds[3].voxels.push_back({i, i, i});
  for (std::int32_t i = 0; i < 1 << 16; ++i)  // charts of the least size
    for (std::int32_t j = 0; j < 16; ++j)
      clouds[4].voxels.push_back({i % 256 * 16 + j % 4, i / 256 * 16 + j / 4, 8});
  for (std::int32_t i = 0; i < 1 << 14; ++i)  // thin boxes, hard to pack
    for (std::int32_t j = 0; j < 20 + i % 23; ++j)
      clouds[5].voxels.push_back({i % 64 * 64 + j, i / 64 * 16, 8});
  for (const NamedCloud& cloud : clouds) {
    SCOPED_TRACE(cloud.name);
    const auto codes = test::codes(test::sorted_distinct(cloud.voxels));
    const auto atlas = derive_atlas(codes, cloud.bits, 0);
    ASSERT_TRUE(atlas);
    expect_a_pixel_for_every_point(*atlas, codes.size());
    EXPECT_LE(static_cast<std::size_t>(atlas->width) * static_cast<std::size_t>(atlas->height),
              16 * codes.size() + 64 * 8192);
  }
}

TEST(Spec_8_11_4_Boxes, EachGoesToTheLowestPlaceThenTheLeftmost) {
  std::vector<Box> boxes = {{3, 4}, {2, 3}, {2, 2}, {2, 1}, {7, 1}};
  EXPECT_EQ(pack_boxes(boxes, 7), 5);
  const std::vector<std::array<std::int32_t, 2>> places = {{0, 0}, {3, 0}, {5, 0}, {5, 2}, {0, 4}};
  for (std::size_t i = 0; i < boxes.size(); ++i)
    EXPECT_EQ((std::array{boxes[i].x, boxes[i].y}), places[i]) << i;
}

TEST(TexturePadding, KeepsWhatIsOccupiedAndStaysBetweenItsExtremes) {
  std::vector<std::uint16_t> samples(72 * 40, 4095);
  std::vector<std::uint8_t> occupied(samples.size(), 0);
  for (std::size_t i = 0; i < samples.size(); i += 37) {
    samples[i] = static_cast<std::uint16_t>(100 + i % 700);
    occupied[i] = 1;
  }
  auto padded = samples;
  pad_picture(padded, occupied, 72, 40);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    if (occupied[i]) {
      EXPECT_EQ(padded[i], samples[i]);
    }
    EXPECT_GE(padded[i], 100);
    EXPECT_LT(padded[i], 800);
  }
}

}  // namespace
}  // namespace slf::texture_atlas_test
