// SPDX-License-Identifier: Apache-2.0
// Which cameras are input and which are held out.
#include <gmock/gmock.h>

#include "slf/capture.h"

namespace slf::splits_test {
namespace {

using ::testing::ElementsAre;

TEST(Splits, WithoutNamesEveryFourthIsHeldOut) {
  Capture capture;
  capture.cameras.resize(9);
  EXPECT_THAT(*split_cameras(capture, ""), ElementsAre(0, 1, 2, 4, 5, 6, 8));
  EXPECT_THAT(*split_cameras(capture, "evaluation"), ElementsAre(3, 7));
  capture.splits["evaluation"] = {0, 1};
  EXPECT_THAT(*split_cameras(capture, ""), ElementsAre(2, 3, 4, 5, 6, 7, 8));
}

TEST(Splits, OneOfNIsEveryNthOfWhatIsNotHeldOut) {
  Capture capture;
  capture.cameras.resize(9);
  EXPECT_THAT(*split_cameras(capture, "1/1"), ElementsAre(0, 1, 2, 4, 5, 6, 8));
  EXPECT_THAT(*split_cameras(capture, "1/3"), ElementsAre(0, 4, 8));
  capture.splits["evaluation"] = {0, 1};
  capture.splits["dense"] = {2};
  EXPECT_THAT(*split_cameras(capture, "1/2"), ElementsAre(2, 4, 6, 8));
  for (const char* wrong : {"1/0", "1/", "1/-2", "1/2x", "2/3", "1/99999"})
    EXPECT_FALSE(split_cameras(capture, wrong)) << wrong;
}

}  // namespace
}  // namespace slf::splits_test
