// Photographs to .slf and back, on a small synthetic capture.
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
namespace {

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
    auto result = encode(capture_, *split_cameras(capture_, ""), settings);
    EXPECT_TRUE(result) << result.error().message;
    return made[preset] = *std::move(result);
  }

  static Result<Encoded, InputError> encoded_to(std::uint64_t bytes, double psnr) {
    EncoderSettings settings;
    settings.grid_bits = 6;
    settings.target_bytes = bytes;
    settings.target_psnr = psnr;
    return encode(capture_, *split_cameras(capture_, "sparse"), settings);
  }

  /// Of pictures.
  static double psnr(const Encoded& e, const char* split, const DecodeOptions& options = {}) {
    const auto field = decode(e.stream, options);
    EXPECT_TRUE(field);
    return evaluate(ViewMaps(*field), capture_, *split_cameras(capture_, split), {})->image.psnr;
  }

  static inline std::filesystem::path root_;
  static inline Capture capture_;
};

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

TEST_F(EndToEnd, MoreEffortIsBetterBetweenTheCameras) {
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
  EXPECT_EQ(settings_of(Preset::kPaper, 1).fit.basis, settings_of(Preset::kPaper, 9).fit.basis);
  EXPECT_FALSE(settings_of(Preset::kPaper, 9).search.any());
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

TEST_F(EndToEnd, StepsOfBsplinesAreInverseToTheNorms) {
  EncoderSettings settings;
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

TEST_F(EndToEnd, TheTargetInBytesIsMetWithinOnePercent) {
  for (const std::uint64_t target : {4000u, 12000u}) {
    const auto e = encoded_to(target, 0);
    ASSERT_TRUE(e) << e.error().message;
    EXPECT_LE(e->stream.size(), target);
    EXPECT_GE(e->stream.size(), target - target / 100);
    EXPECT_TRUE(e->warnings.empty());
  }
}

TEST_F(EndToEnd, TheTargetInDecibelsIsMetByTheFile) {
  const auto e = encoded_to(0, 26);
  ASSERT_TRUE(e) << e.error().message;
  EXPECT_GE(psnr(*e, "sparse"), 26);
  EXPECT_LE(psnr(*e, "sparse"), 26.06);
}

TEST_F(EndToEnd, ATargetThatCannotBeMetIsSaidAndTheNearestIsWritten) {
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
}  // namespace slf
