// SPDX-License-Identifier: Apache-2.0
// Colours of photographs as video has them, and back.
#include "tools/rd/igc/ycbcr.h"

#include <gtest/gtest.h>

namespace slf::ycbcr_test {
namespace {

TEST(Ycbcr, BackAndForthStaysWithinTheRounding) {
  Image image{7, 5, 3, {}};
  for (int i = 0; i < 7 * 5 * 3; ++i) image.data.push_back(static_cast<std::uint8_t>(i * 37 % 256));
  const Image back = to_rgb(to_ycbcr(image, IgcChroma::k444), 7, 5);
  ASSERT_EQ(back.data.size(), image.data.size());
  for (std::size_t i = 0; i < image.data.size(); ++i)
    EXPECT_NEAR(back.data[i], image.data[i], 3) << "sample " << i;
}

TEST(Ycbcr, AnEvenColourSurvivesHalvedChromaOfAnOddSize) {
  Image image{7, 5, 4, {}};
  for (int i = 0; i < 7 * 5; ++i) image.data.insert(image.data.end(), {200, 40, 90, 255});
  const Picture picture = to_ycbcr(image, IgcChroma::k420);
  EXPECT_EQ(picture.width, 8);
  EXPECT_EQ(picture.planes[1].size(), 4u * 3);
  const Image back = to_rgb(picture, 7, 5);
  for (std::size_t i = 0; i < back.data.size(); ++i)
    EXPECT_NEAR(back.data[i], image.data[i % 3], 2) << "sample " << i;
}

TEST(Ycbcr, ChromaIsInterpolatedAtTheRightPlaces) {
  // A ramp of blue differences: bilinear interpolation of the means of pairs gives it back inside.
  Image image{16, 2, 3, {}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 16; ++x)
      for (const int value : {100, 100, 100 + 4 * x})
        image.data.push_back(static_cast<std::uint8_t>(value));
  const Image back = to_rgb(to_ycbcr(image, IgcChroma::k420), 16, 2);
  for (std::size_t x = 1; x < 15; ++x)
    EXPECT_NEAR(back.data[3 * x + 2], 100 + 4 * static_cast<double>(x), 2) << "pixel " << x;
}

}  // namespace
}  // namespace slf::ycbcr_test
