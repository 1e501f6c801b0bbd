// SPDX-License-Identifier: Apache-2.0
// A small synthetic capture and what it is encoded to: made once for the tests of a program.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <map>

#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/evaluate.h"
#include "slf/view_map.h"
#include "tools/synth/synth.h"

namespace slf {

class EndToEnd : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = std::filesystem::path(testing::TempDir()) /
            ("slf_end_to_end_" + std::to_string(::getpid()));
    std::filesystem::remove_all(root_);
    synth::SynthSettings settings;
    settings.scene = "can";
    settings.width = settings.height = 96;
    const auto made = synth::synthesise(settings, root_, {});
    ASSERT_TRUE(made) << made.error().message;
    auto capture = load_capture(root_);
    ASSERT_TRUE(capture) << capture.error().message;
    capture_ = *std::move(capture);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  /// On 7 bits, Q = 16, made once.
  static const Encoded& encoded(Preset preset) {
    static std::map<Preset, Encoded> made;
    if (const auto at = made.find(preset); at != made.end()) return at->second;
    EncoderSettings settings = settings_of(preset);
    settings.grid_bits = 7;
    settings.q = kPlainQ;
    auto result = encode(capture_, *split_cameras(capture_, ""), settings);
    EXPECT_TRUE(result) << result.error().message;
    return made[preset] = *std::move(result);
  }

  /// PSNR of pictures.
  static double psnr(const Encoded& e, const char* split, const DecodeOptions& options = {}) {
    const auto field = decode(e.stream, options);
    EXPECT_TRUE(field);
    return evaluate(ViewMaps(*field), capture_, *split_cameras(capture_, split), {})->image.psnr;
  }

  static inline std::filesystem::path root_;
  static inline Capture capture_;
};

}  // namespace slf
