// SPDX-License-Identifier: Apache-2.0
// slf encode --work --resume: an encode that trains goes on where it was interrupted.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "cli_support.h"

namespace slf::cli_resume_test {
namespace {

namespace fs = std::filesystem;

class ResumeTest : public CliTest {
 protected:
  static constexpr const char* kEncode =
      "encode vase --surface trained --effort 1 -q 16 --quiet -o ";

  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth vase -o vase --size 64x64 --points 3000 --circles 5 --per-circle 20 "
                  "--hull 4 --supersampling 1 --quiet")
                  .code,
              0);
  }
};

TEST_F(ResumeTest, AnInterruptLeavesNoHalfFileAndTheNextRunGoesOnToTheSameBytes) {
  ASSERT_EQ(slf(std::string(kEncode) + "whole.slf").code, 0);
  // Interrupted as soon as there is a checkpoint.
  const Ran cut = shell(std::string("'" SLF_PROGRAM "' ") + kEncode +
                        "cut.slf --work work & p=$!; "
                        "while kill -0 $p 2>.kill && ! ls work/*.checkpoint >.ls 2>&1; "
                        "do sleep 0.05; done; kill -TERM $p; wait $p");
  ASSERT_EQ(cut.code, 130) << "it was done before it could be interrupted: " << cut.err;
  EXPECT_FALSE(exists("cut.slf"));
  EXPECT_TRUE(leftovers().empty());
  const Ran again = slf(std::string(kEncode) + "cut.slf --work work --resume");
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(read("cut.slf"), read("whole.slf"));
}

TEST_F(ResumeTest, WithoutAWorkDirectoryItIsRefused) {
  expect_failure(slf(std::string(kEncode).append("x.slf --resume")), 2, "--work", "--resume");
  expect_failure(slf(std::string(kEncode).append("x.slf --work w --resume --surface-seconds 1")), 2,
                 "--resume", "--surface-seconds");
}

}  // namespace
}  // namespace slf::cli_resume_test
