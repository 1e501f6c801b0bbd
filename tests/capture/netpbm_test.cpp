// SPDX-License-Identifier: Apache-2.0
// PPM and PGM: ppm(5) and pgm(5) of Netpbm.
#include <gmock/gmock.h>

#include "capture/image_formats.h"
#include "image_files.h"

namespace slf::netpbm_test {
namespace {

using test::bytes;
using testing::HasSubstr;
using Data = std::vector<std::uint8_t>;

Data data_of(const std::string& file) {
  const auto image = test::read(file);
  EXPECT_TRUE(image) << image.error().message;
  return image ? image->data : Data{};
}

TEST(Netpbm, AllFourKindsAreRead) {
  EXPECT_EQ(data_of("P6\n2 1\n255\n" + bytes({1, 2, 3, 250, 251, 252})),
            (Data{1, 2, 3, 250, 251, 252}));
  EXPECT_EQ(data_of("P5 2 1 255 " + bytes({7, 200})), (Data{7, 7, 7, 200, 200, 200}));
  EXPECT_EQ(data_of("P3\n1 2 # as wide\n255\n1 2 3\n4 5 6"), (Data{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(data_of("P2 1 1 255 9"), (Data{9, 9, 9}));
}

TEST(Netpbm, SamplesAreScaledToEightBits) {
  EXPECT_EQ(data_of("P5 3 1 1\n" + bytes({0, 1, 0})), (Data{0, 0, 0, 255, 255, 255, 0, 0, 0}));
  EXPECT_EQ(data_of("P5 2 1 65535\n" + bytes({255, 255, 128, 0})),
            (Data{255, 255, 255, 128, 128, 128}));
}

TEST(Netpbm, SizesAreKnownFromTheHeader) {
  const test::TemporaryDirectory directory;
  test::write_text(directory / "a.ppm", "P6 # by hand\n# two lines\n640 480\n255\n");
  const auto size = read_image_size(directory / "a.ppm");
  ASSERT_TRUE(size);
  EXPECT_EQ(size->width, 640u);
  EXPECT_EQ(size->height, 480u);
}

TEST(Netpbm, EveryTruncationIsRefused) {
  for (const std::string& whole : {"P6\n2 1\n255\n" + bytes({1, 2, 3, 250, 251, 252}),
                                   std::string("P3 1 2 255 10 20 30 40 50 60")})
    for (std::size_t size = 0; size + 1 < whole.size(); ++size) {
      const auto image = test::read(whole.substr(0, size));
      ASSERT_FALSE(image) << size;
      EXPECT_EQ(image.error().code, Errc::kInvalidInput);
    }
}

TEST(Netpbm, WhatIsTooLargeIsRefusedBeforeItIsAllocated) {
  EXPECT_THAT(test::read("P6 65535 65535 255 ").error().message, HasSubstr("larger than accepted"));
  EXPECT_THAT(test::read("P6 0 1 255 ").error().message, HasSubstr("0 x 1"));
  EXPECT_THAT(test::read("P6 99999 1 255 ").error().message, HasSubstr("without a sound header"));
  EXPECT_THAT(test::read("P5 1 1 0 a").error().message, HasSubstr("without a sound header"));
  EXPECT_THAT(test::read("P5 1 1 9 a").error().message, HasSubstr("above 9"));
}

}  // namespace
}  // namespace slf::netpbm_test
