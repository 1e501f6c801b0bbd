// SPDX-License-Identifier: Apache-2.0
// A small synthetic capture, coded as images plus geometry. What includes it links slf_synth.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>
#include <vector>

#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/view_map.h"
#include "tests/attributes/video_support.h"
#include "tools/rd/igc/igc.h"
#include "tools/synth/synth.h"

namespace slf::test {

class Igc : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = std::filesystem::path(testing::TempDir()) / ("slf_igc_" + std::to_string(::getpid()));
    std::filesystem::remove_all(root_);
    synth::SynthSettings settings;
    settings.scene = "can";
    settings.width = 75;  // odd: 4:2:0 has to add a column
    settings.height = 66;
    settings.points = 4000;
    settings.circles = 4;
    settings.per_circle = 10;
    const auto made = synth::synthesise(settings, root_, {});
    ASSERT_TRUE(made) << made.error().message;
    auto capture = load_capture(root_);
    ASSERT_TRUE(capture) << capture.error().message;
    capture_ = *std::move(capture);
    capture_.cloud.normals.clear();  // as the decoder has it
    cameras_ = *split_cameras(capture_, "dense");
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  static IgcSettings settings(int qp, IgcChroma chroma = IgcChroma::k420) {
    IgcSettings s;
    s.slf.grid_bits = 6;
    s.slf.surface = Surface::kGiven;
    s.slf.fit = {};  // the quickest
    s.slf.search = FitSearch::none();
    s.slf.metadata = {{"split", "dense"}};
    s.qp = qp;
    s.chroma = chroma;
    s.speed = "fast";
    return s;
  }

  static IgcEncoded encoded(const IgcSettings& s) {
    auto result = encode_igc(capture_, cameras_, s);
    EXPECT_TRUE(result) << result.error().message;
    return result ? *std::move(result) : IgcEncoded{};
  }

  static double psnr(const LightField& field) {
    const ViewMaps maps(field);
    EvaluateSettings s;
    s.images = false;
    return evaluate(maps, capture_, cameras_, s)->points[0].psnr;
  }

  static double decoded_psnr(const IgcEncoded& e) {
    const auto decoded = decode_igc(e.stream, capture_);
    EXPECT_TRUE(decoded) << decoded.error().message;
    return decoded ? psnr(decoded->light_field) : 0;
  }

  /// What a decoder has: calibration. Files that do not exist, no points.
  static Capture calibration() {
    Capture bare;
    bare.cameras = capture_.cameras;
    bare.image_files.assign(bare.cameras.size(), "/nowhere/image.png");
    bare.mask_files.assign(bare.cameras.size(), "/nowhere/mask.png");
    return bare;
  }

  static inline std::filesystem::path root_;
  static inline Capture capture_;
  static inline std::vector<int> cameras_;
};

}  // namespace slf::test
