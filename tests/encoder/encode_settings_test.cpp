// SPDX-License-Identifier: Apache-2.0
// What is asked of an encode is what its file has: efforts, targets, steps.
#include "end_to_end.h"

namespace slf::encode_settings_test {
namespace {

class EncodeSettings : public EndToEnd {
 protected:
  static Result<Encoded, InputError> encoded_to(std::uint64_t bytes, double psnr) {
    EncoderSettings settings;
    settings.surface = Surface::kGiven;
    settings.grid_bits = 6;
    settings.target_bytes = bytes;
    settings.target_psnr = psnr;
    return encode(capture_, *split_cameras(capture_, "sparse"), settings);
  }
};

TEST_F(EncodeSettings, MoreEffortIsBetterBetweenTheCameras) {
  double last = 0;
  for (const int effort : {1, 3, 6}) {
    EncoderSettings settings = settings_of(Preset::kDefault, effort);
    settings.grid_bits = 6;
    settings.target_bytes = 8000;
    const auto e = encode(capture_, *split_cameras(capture_, ""), settings);
    ASSERT_TRUE(e) << e.error().message;
    const double now = psnr(*e, "evaluation");
    EXPECT_GT(now, last) << effort;
    last = now;
  }
}

TEST(Effort, SevenIsWhatSettingsStartWithAndThePaperHasNone) {
  const EncoderSettings start, seven = settings_of(Preset::kDefault, 7);
  EXPECT_EQ(seven.fit.basis, start.fit.basis);
  EXPECT_EQ(seven.fit.environment.degree, start.fit.environment.degree);
  EXPECT_EQ(seven.search.points, start.search.points);
  EXPECT_TRUE(seven.search.any());
  EXPECT_EQ(settings_of(Preset::kPaper, 1).fit.basis, settings_of(Preset::kPaper, 8).fit.basis);
  EXPECT_FALSE(settings_of(Preset::kPaper, 8).search.any());
}

/// A matte object in the mirrored frame costs a sixth more bytes and 0.6 dB (docs/decisions/017).
TEST(Effort, WhereGeometryIsMendedTheFrameIsSearchedAndBelowTheDefaultNothingElse) {
  for (int effort = 1; effort <= kMostEffort; ++effort) {
    const EncoderSettings s = settings_of(Preset::kDefault, effort);
    EXPECT_EQ(s.search.directions, s.surface == Surface::kAuto) << effort;
    for (const bool searched :
         {s.search.strength, s.search.growth, s.search.point_penalty, s.search.pictures})
      EXPECT_EQ(searched, effort >= kDefaultEffort) << effort;
    EXPECT_FALSE(s.search.basis) << effort;
  }
}

TEST_F(EncodeSettings, StepsOfBsplinesAreInverseToTheNorms) {
  EncoderSettings settings;
  settings.surface = Surface::kGiven;
  settings.fit = {};
  settings.search = FitSearch::none();
  settings.transform = TransformMode::kNone;
  settings.grid_bits = 6;
  settings.q = 8;
  const auto e = encode(capture_, *split_cameras(capture_, ""), settings);
  ASSERT_TRUE(e) << e.error().message;
  const auto info = read_info(e->stream);
  ASSERT_TRUE(info);
  const auto norms = basis_norms(info->header.basis);
  for (std::size_t k = 0; k < 128; ++k)
    EXPECT_NEAR(info->step[k][0], 4 / norms[k] * (1 << info->header.shift[k]), 0.5);
  EXPECT_EQ(info->num_groups, 4);
}

TEST_F(EncodeSettings, TheTargetInBytesIsMetWithinOnePercent) {
  for (const std::uint64_t target : {4000u, 12000u}) {
    const auto e = encoded_to(target, 0);
    ASSERT_TRUE(e) << e.error().message;
    EXPECT_LE(e->stream.size(), target);
    EXPECT_GE(e->stream.size(), target - target / 100);
    EXPECT_TRUE(e->warnings.empty());
  }
}

TEST_F(EncodeSettings, TheTargetInDecibelsIsMetByTheFile) {
  const auto e = encoded_to(0, 26);
  ASSERT_TRUE(e) << e.error().message;
  EXPECT_GE(psnr(*e, "sparse"), 26);
  EXPECT_LE(psnr(*e, "sparse"), 26.06);
}

TEST_F(EncodeSettings, ATargetThatCannotBeMetIsSaidAndTheNearestIsWritten) {
  const auto small = encoded_to(10, 0);
  ASSERT_TRUE(small);
  ASSERT_EQ(small->warnings.size(), 1u);
  EXPECT_EQ(small->q, 4096);
  const auto good = encoded_to(0, 99);
  ASSERT_TRUE(good);
  EXPECT_EQ(good->warnings.size(), 1u);
  EXPECT_LT(good->q, 0.2);
  const auto both = encoded_to(1000, 30);
  ASSERT_FALSE(both);
  EXPECT_EQ(both.error().code, Errc::kInvalidArgument);
}

}  // namespace
}  // namespace slf::encode_settings_test
