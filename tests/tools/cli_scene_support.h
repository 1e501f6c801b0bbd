// SPDX-License-Identifier: Apache-2.0
// A scene for tests of parts.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "cli_support.h"

namespace slf::cli_scene {

/// A street of two houses in six slices, and what it is in one process.
class SceneTest : public CliTest {
 protected:
  static constexpr const char* kSettings =
      " --slice-points 2500 --effort 1 --degree 3 --grid-bits 9 -j 2 --quiet";

  void SetUp() override {
    CliTest::SetUp();
    ASSERT_EQ(slf("synth terrace -o street --houses 2 --points 15000 --cameras 10 --size 96x72 "
                  "--quiet")
                  .code,
              0);
  }

  Ran plan(const std::string& more = "") {
    return slf("plan street -o plan.json --work work" + (kSettings + more));
  }
  Ran part(const std::string& which, const std::string& output, const std::string& more = "") {
    return slf("encode street --plan plan.json --work work --quiet --part " + which + " -o " +
               output + more);
  }
};

}  // namespace slf::cli_scene
