// SPDX-License-Identifier: Apache-2.0
// What a person reads while they wait.
#include "tools/progress.h"

#include <gtest/gtest.h>

namespace slf::tools::progress_test {
namespace {

TEST(ProgressText, SaysWhatIsLeftOnceThatCanBeTold) {
  EXPECT_EQ(progress_text("fit", 0.42, 1), "fit 42 %");
  EXPECT_EQ(progress_text("fit", 0.5, 65), "fit 50 %, 1:05 left");
  EXPECT_EQ(progress_text("fit", 0.9, 9), "fit 90 %, 0:01 left");
  EXPECT_EQ(progress_text("fit", 0.01, 600), "fit 1 %");  // a guess would be wild
  EXPECT_EQ(progress_text("fit", 1, 600), "fit 100 %");
  EXPECT_EQ(progress_text("load", -3, 0), "load 0 %");
}

}  // namespace
}  // namespace slf::tools::progress_test
