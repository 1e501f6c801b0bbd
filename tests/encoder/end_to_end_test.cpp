// SPDX-License-Identifier: Apache-2.0
// Photographs to .slf and back, on a small synthetic capture.
#include "end_to_end.h"

namespace slf::end_to_end_test {
namespace {

TEST_F(EndToEnd, QualityAndBytesStayWhereTheyWereMeasured) {
  // Measured, of pictures: 27.53 dB, 26.45 dB, 38,188 bytes.
  const Encoded& e = encoded(Preset::kDefault);
  EXPECT_GT(psnr(e, "dense"), 27.3);
  EXPECT_GT(psnr(e, "evaluation"), 26.2);
  EXPECT_LT(e.stream.size(), 39000u);
}

TEST_F(EndToEnd, AFitToPicturesGivesBetterPicturesBetweenTheCamerasToo) {
  EncoderSettings settings = settings_of(Preset::kDefault, 4);
  settings.grid_bits = 7;
  const auto cameras = *split_cameras(capture_, "");
  const auto pictures = encode(capture_, cameras, settings);
  settings.fit.pictures.rounds = 0;
  const auto points = encode(capture_, cameras, settings);
  ASSERT_TRUE(pictures && points);
  EXPECT_GT(psnr(*pictures, "evaluation"), psnr(*points, "evaluation") + 1);
  EXPECT_GT(pictures->pictures.psnr_after, pictures->pictures.psnr_before + 1);
  EXPECT_EQ(points->pictures.pull, 0);
}

TEST_F(EndToEnd, HeldOutCamerasDecideHowFarPicturesPull) {
  const Encoded& e = encoded(Preset::kDefault);
  EXPECT_GT(e.pictures.pull, 0);
  EXPECT_GT(e.pictures.held_out_after, e.pictures.held_out_before);
}

TEST_F(EndToEnd, TheFreeDcIsBetterBetweenTheCamerasAtFewerBytes) {
  const Encoded &paper = encoded(Preset::kPaper), &ours = encoded(Preset::kDefault);
  EXPECT_LT(5 * ours.stream.size(), paper.stream.size());
  EXPECT_GT(psnr(ours, "evaluation"), psnr(paper, "evaluation") + 1);
}

TEST_F(EndToEnd, ThePaperPresetIsThePaper) {
  const auto info = read_info(encoded(Preset::kPaper).stream);
  ASSERT_TRUE(info);
  EXPECT_EQ(info->header.basis, (Basis{BasisId::kBspline, 2, 4, 3}));
  EXPECT_EQ(info->header.colour, ColourTransform::kNone);
  EXPECT_EQ(info->coefficient_coder, "independent");
  for (std::size_t k = 0; k < 128; ++k)
    EXPECT_EQ(info->step[k][0], 16u << info->header.shift[k]) << "function " << k;
  std::size_t units = 0;
  for (const UnitInfo& unit : info->units) units += unit.type == "coefficients";
  EXPECT_EQ(units, 1u);
}

TEST_F(EndToEnd, MoreBytesOfAFileAreNeverWorse) {
  const Encoded& e = encoded(Preset::kDefault);
  double last = 0;
  for (const int groups : {1, 2, 4}) {
    DecodeOptions options;
    options.groups = groups;
    const double now = psnr(e, "dense", options);
    EXPECT_GT(now, last) << groups << " groups";
    last = now;
  }
}

}  // namespace
}  // namespace slf::end_to_end_test
