// SPDX-License-Identifier: Apache-2.0
// A step that is not given: what it costs, where it cannot be chosen, and what it leaves alone.
#include "encoder/choose_step.h"

#include "codec/encoder/quantise_field.h"
#include "end_to_end.h"
#include "slf/given_planes.h"
#include "tests/codec/field_support.h"

namespace slf::choose_step_test {
namespace {

class ChooseStep : public EndToEnd {
 protected:
  static EncoderSettings quick() {
    EncoderSettings settings = settings_of(Preset::kDefault, 4);
    settings.grid_bits = 7;
    settings.surface = Surface::kGiven;
    return settings;
  }
  static Encoded encoded_with(const EncoderSettings& settings, const char* split = "") {
    auto e = encode(capture_, *split_cameras(capture_, split), settings);
    EXPECT_TRUE(e) << e.error().message;
    return e ? *std::move(e) : Encoded{};
  }
  static Encoded encoded_with(double q) {
    EncoderSettings settings = quick();
    settings.q = q;
    return encoded_with(settings);
  }
  static const Encoded& chosen() {
    static const Encoded e = encoded_with(quick());
    return e;
  }
};

TEST_F(ChooseStep, CostsPicturesThatNoFitHasSeenNoMoreThanIsStated) {
  EncoderSettings settings = quick();
  settings.quality_loss = 0.6;
  const Encoded e = encoded_with(settings);
  ASSERT_EQ(e.step.origin, ChosenStep::kChosen) << reason_of(e.step);
  EXPECT_GT(e.q, kPlainQ);
  EXPECT_LE(e.step.loss, settings.quality_loss);
  const double fine = psnr(encoded_with(0.5), "evaluation");
  // What is measured on a sample of the input tells of others within some hundredths of a decibel.
  EXPECT_LT(fine - psnr(e, "evaluation"), settings.quality_loss + 0.05);
  EXPECT_LT(fine - psnr(encoded_with(e.q / 2), "evaluation"), fine - psnr(e, "evaluation") + 0.05);
}

TEST_F(ChooseStep, CostsPicturesOfFewCamerasNoMoreThanIsStated) {
  const std::vector<int> dense = *split_cameras(capture_, "");
  std::vector<int> few;
  for (std::size_t i = 0; i < 27; ++i) few.push_back(dense[i * dense.size() / 27]);
  const auto with = [&](double q, double loss) {
    EncoderSettings settings = quick();
    settings.q = q;
    settings.quality_loss = loss;
    auto e = encode(capture_, few, settings);
    EXPECT_TRUE(e) << e.error().message;
    return e ? *std::move(e) : Encoded{};
  };
  const double fine = psnr(with(0.5, 0.1), "evaluation");
  for (const double loss : {0.1, 0.6}) {
    const Encoded e = with(kAutomaticQ, loss);
    ASSERT_EQ(e.step.origin, ChosenStep::kChosen) << reason_of(e.step);
    EXPECT_LT(fine - psnr(e, "evaluation"), std::max(loss, e.step.loss) + 0.15) << e.q;
  }
}

TEST_F(ChooseStep, IsNeverFinerThanThePlainOneAndSaysWhatThatCosts) {
  EXPECT_EQ(chosen().q, kPlainQ);
  EXPECT_GT(chosen().step.loss, EncoderSettings{}.quality_loss);
}

TEST_F(ChooseStep, IsLargerWhereMoreMayBeLost) {
  EncoderSettings settings = quick();
  settings.quality_loss = 1;
  const Encoded coarse = encoded_with(settings);
  EXPECT_GT(coarse.q, 1.2 * chosen().q);
  EXPECT_LT(coarse.stream.size(), chosen().stream.size());
}

TEST_F(ChooseStep, GivesTheFileOfThatStepGiven) {
  const Encoded& e = chosen();
  const Encoded given = encoded_with(e.q);
  EXPECT_EQ(given.step.origin, ChosenStep::kGiven);
  const auto a = decode(e.stream), b = decode(given.stream);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->positions, b->positions);
  EXPECT_EQ(a->components, b->components) << "choosing changed the fit";
  const auto of_chosen = read_info(e.stream), of_given = read_info(given.stream);
  ASSERT_TRUE(of_chosen && of_given);
  const auto has = [](const Metadata& metadata, const char* key) {
    return std::any_of(metadata.begin(), metadata.end(),
                       [&](const auto& pair) { return pair.first == key; });
  };
  EXPECT_TRUE(has(of_chosen->metadata, "quality_loss"));
  EXPECT_FALSE(has(of_given->metadata, "quality"));
}

TEST_F(ChooseStep, IsTheSameForAnyNumberOfThreads) {
  EncoderSettings settings = quick();
  settings.threads = 3;
  const Encoded three = encoded_with(settings);
  EXPECT_EQ(three.q, chosen().q);
  EXPECT_EQ(three.stream, chosen().stream);
}

TEST_F(ChooseStep, IsThePlainOneWithAReasonWhereNoPictureCanBeHeldOut) {
  EncoderSettings settings = quick();
  settings.grid_bits = 5;
  settings.fit.pictures.rounds = 0;
  const Encoded points = encoded_with(settings);
  EXPECT_EQ(points.step.origin, ChosenStep::kNoPictures);
  EXPECT_EQ(points.q, kPlainQ);
  settings = quick();
  settings.grid_bits = 5;
  const std::vector<int> few = {0, 20, 40, 60, 80};
  const auto five = encode(capture_, few, settings);
  ASSERT_TRUE(five) << five.error().message;
  EXPECT_EQ(five->step.origin, ChosenStep::kTooFewCameras);
  EXPECT_EQ(five->q, kPlainQ);
  Capture coloured;
  coloured.cloud.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 1}};
  coloured.cloud.colours = {{10, 20, 30}, {40, 50, 60}, {70, 80, 90}};
  settings = {};
  settings.grid_bits = 3;
  const auto cloud = encode(coloured, {}, settings);
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->step.origin, ChosenStep::kNoCameras);
  EXPECT_EQ(cloud->q, kPlainQ);
  for (const Encoded* e : {&points, &*five, &*cloud})
    EXPECT_NE(reason_of(e->step).find("not chosen"), std::string::npos);
}

TEST_F(ChooseStep, ThePaperHasANumber) {
  EXPECT_EQ(settings_of(Preset::kPaper).q, 16);
  EXPECT_EQ(settings_of(Preset::kDefault).q, kAutomaticQ);
  EncoderSettings paper = settings_of(Preset::kPaper);
  paper.grid_bits = 5;
  paper.fit.iterations = 1;
  const Encoded e = encoded_with(paper, "sparse");
  EXPECT_EQ(e.q, 16);
  EXPECT_EQ(e.step.origin, ChosenStep::kGiven);
}

TEST_F(ChooseStep, ALossOutOfRangeIsRefused) {
  for (const double loss : {0.0, -1.0, 10.5, std::nan("")}) {
    EncoderSettings settings;
    settings.quality_loss = loss;
    const auto e = encode(capture_, *split_cameras(capture_, "sparse"), settings);
    ASSERT_FALSE(e) << loss;
    EXPECT_EQ(e.error().code, Errc::kInvalidArgument);
    EXPECT_NE(e.error().message.find("quality-loss"), std::string::npos);
  }
}

TEST(QuantiseField, IsWhatADecoderGetsOfOneSliceWithoutABase) {
  for (const TransformMode mode : {TransformMode::kNone, TransformMode::kFunctions}) {
    const LightField field = test::make_field(test::sphere_cloud(5), 5, 9);
    CodingParameters parameters;
    parameters.base_levels = 0;
    parameters.transform = mode;
    parameters.step.assign(9, {40, 40, 40});
    const auto quantised = quantise_field(field, parameters, 1);
    const auto stream = pack(field, parameters);
    ASSERT_TRUE(quantised && stream);
    const auto decoded = decode(*stream);
    ASSERT_TRUE(decoded);
    EXPECT_EQ(quantised->positions, decoded->positions);
    EXPECT_EQ(quantised->components, decoded->components);
    EXPECT_EQ(given_planes(*quantised), given_planes(*decoded));
  }
}

TEST(SpreadCells, AreWholeAndAboutAsManyPointsAsAsked) {
  const std::vector<Voxel> cloud = test::sphere_cloud(7);
  const auto points = spread_cells(cloud, 0, cloud.size() / 6);
  EXPECT_GT(points.size(), cloud.size() / 12);
  EXPECT_LT(points.size(), cloud.size() / 3);
  EXPECT_TRUE(std::is_sorted(points.begin(), points.end()));
  EXPECT_EQ(spread_cells(cloud, 0, cloud.size()).size(), cloud.size());
}

}  // namespace
}  // namespace slf::choose_step_test
