// SPDX-License-Identifier: Apache-2.0
// Pictures against photographs: masks, borders, regions, error maps. Spec annex D.
#include <cmath>
#include <utility>

#include "evaluate_support.h"

namespace slf::evaluate_pictures_test {
namespace {

using namespace test;

TEST_F(EvaluateTest, CoverageIsTheShareOfTheObjectThatIsDrawn) {
  // Only the lower half of the plate was decoded.
  std::vector<Voxel> half;
  for (const Voxel& v : test::plane(32, 0))
    if (v[1] >= 16) half.push_back(v);
  const ViewMaps maps(constant_light_field(half, {{100, 100, 100}}, 5));
  add_photograph({100, 100, 100});
  const std::vector<int> cameras{0};
  const auto quality = evaluate(maps, capture_, cameras, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_NEAR(quality->image.coverage, 0.5, 0.05);
}

TEST_F(EvaluateTest, AlphaOfAPhotographIsItsMask) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 100, 100}}, 5));
  add_photograph({110, 110, 110}, 4);
  const std::vector<int> cameras{0};
  const auto quality = evaluate(maps, capture_, cameras, {});
  ASSERT_TRUE(quality) << quality.error().message;
  EXPECT_NEAR(double(quality->points[0].observations), 32 * 16,
              33);  // one column at the mask's edge
  EXPECT_NEAR(quality->image.psnr, 20 * std::log10(25.5), 0.2);
  EXPECT_GT(quality->image.coverage, 0.99);
}

TEST_F(EvaluateTest, AnUncoveredPixelIsComparedAsThePhotographsOwnBorder) {
  // The object is the middle of a photograph with a border of another colour.
  capture_.cloud = {};
  std::vector<Voxel> square;
  for (const Voxel& v : test::plane(32, 0))
    if (v[0] >= 8 && v[0] < 24 && v[1] >= 8 && v[1] < 24) {
      square.push_back(v);
      capture_.cloud.positions.push_back({float(v[0]), float(v[1]), float(v[2])});
      capture_.cloud.normals.push_back({0, 0, -1});
    }
  const ViewMaps maps(constant_light_field(square, {{100, 100, 100}}, 5));
  for (const int border : {0, 128, 255}) {
    Image image{kSize, kSize, 3, {}};
    for (int y = 0; y < kSize; ++y)
      for (int x = 0; x < kSize; ++x)
        for (int k = 0; k < 3; ++k)
          image.data.push_back(
              static_cast<std::uint8_t>(x >= 8 && x < 24 && y >= 8 && y < 24 ? 100 : border));
    add_photograph({0, 0, 0});
    ASSERT_TRUE(write_png(capture_.image_files.back(), image));
  }
  // What differs is the antialiased edge, in proportion to its contrast with the border; grey 128
  // in the border's place would differ over the whole background.
  std::vector<double> relative;
  for (const int camera : {0, 1, 2}) {
    const auto quality = evaluate(maps, capture_, std::vector{camera}, {});
    ASSERT_TRUE(quality) << quality.error().message;
    const double contrast = std::array{100, 28, 155}[std::size_t(camera)];
    relative.push_back(quality->image.all.psnr + 20 * std::log10(contrast));
    EXPECT_GT(quality->image.rest.psnr, 45) << camera;
  }
  EXPECT_NEAR(relative[0], relative[1], 0.5);
  EXPECT_NEAR(relative[0], relative[2], 0.5);
}

TEST_F(EvaluateTest, WhatIsBehindAnAlphaOfZeroDoesNotCount) {
  std::vector<Voxel> half;  // nothing is drawn there either
  for (const Voxel& v : test::plane(32, 0))
    if (v[0] < 16) half.push_back(v);
  const ViewMaps maps(constant_light_field(half, {{110, 110, 110}}, 5));
  add_photograph({110, 110, 110}, 4);
  add_photograph({110, 110, 110}, 4);
  auto image = read_image(capture_.image_files[1]);
  ASSERT_TRUE(image);
  for (std::size_t i = 0; i < image->data.size(); i += 4)
    if (image->data[i + 3] == 0) image->data[i] = static_cast<std::uint8_t>(i / 4);
  ASSERT_TRUE(write_png(capture_.image_files[1], *image));
  const auto plain = evaluate(maps, capture_, std::vector{0}, {});
  const auto other = evaluate(maps, capture_, std::vector{1}, {});
  ASSERT_TRUE(plain && other);
  EXPECT_GT(plain->image.all.psnr, 35);  // the edge, of contrast 18
  EXPECT_EQ(plain->image.all.psnr, other->image.all.psnr);
  EXPECT_EQ(plain->image.all.ms_ssim, other->image.all.ms_ssim);
  EXPECT_EQ(plain->image.psnr, other->image.psnr);
}

TEST_F(EvaluateTest, RegionsAndUncoveredPixelsAccountForAllOfTheError) {
  std::vector<Voxel> part;  // what is not drawn of the plate: its lower quarter
  for (const Voxel& v : test::plane(32, 0))
    if (v[1] < 24) part.push_back(v);
  const ViewMaps maps(constant_light_field(part, {{100, 100, 100}, {90, 130, 80}}, 5));
  add_photograph({107, 100, 96});
  const auto quality = evaluate(maps, capture_, std::vector{0}, {});
  ASSERT_TRUE(quality) << quality.error().message;
  const ImageQuality& image = quality->image;
  EXPECT_NEAR(image.rim.pixel_share + image.grazing.pixel_share + image.rest.pixel_share, 1, 1e-12);
  EXPECT_NEAR(image.rim.error_share + image.grazing.error_share + image.rest.error_share, 1, 1e-12);
  EXPECT_EQ(image.grazing.pixel_share, 0) << "the plate faces the camera";
  EXPECT_TRUE(std::isnan(image.grazing.psnr));
  // All of the photograph shows the object, so its border is its own colour and what is not drawn
  // equals it; of all pixels the error is that of the covered ones.
  EXPECT_NEAR(image.coverage, 0.75, 0.05);
  EXPECT_LT(image.uncovered_error_share, 0.05);
  EXPECT_EQ(image.outside_error_share, 0);
  EXPECT_NEAR(image.all.psnr, image.psnr - 10 * std::log10(0.75), 0.4);
}

TEST_F(EvaluateTest, ATiltedPlateIsGrazingWhereItsRaysAre) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 100, 100}}, 5));
  for (const double degrees : {5.0, 15.0}) {
    add_photograph({100, 100, 100});
    Camera& camera = capture_.cameras.back();  // turned about the plate's horizontal axis
    const double angle = (90 - degrees) * 3.14159265358979323846 / 180;
    const double c = std::cos(angle), s = std::sin(angle);
    camera.rotation = {{{1, 0, 0}, {0, c, -s}, {0, s, c}}};
    camera.translation = {-15.5, -c * 15.5, 500 - s * 15.5};
  }
  EvaluateSettings settings;
  settings.deltas_degrees = {0};
  const auto grazing = evaluate(maps, capture_, std::vector{0}, settings);
  const auto steeper = evaluate(maps, capture_, std::vector{1}, settings);
  ASSERT_TRUE(grazing && steeper);
  EXPECT_GT(grazing->image.grazing.pixel_share, 0.99);
  EXPECT_EQ(steeper->image.grazing.pixel_share, 0);
}

TEST_F(EvaluateTest, AnErrorMapShowsPhotographRenderingAndDifference) {
  const ViewMaps maps(constant_light_field(test::plane(32, 0), {{100, 150, 30}}, 5));
  add_photograph({103, 150, 100});
  std::vector<std::pair<int, Image>> got;
  EvaluateSettings settings;
  settings.threads = 1;
  settings.error_map = [&](int camera, const Image& map) -> Result<Done, InputError> {
    got.emplace_back(camera, map);
    return Done{};
  };
  ASSERT_TRUE(evaluate(maps, capture_, std::vector{0}, settings));
  ASSERT_EQ(got.size(), 1u);
  const Image& map = got[0].second;
  ASSERT_EQ(map.width, 3 * kSize);
  ASSERT_EQ(map.height, kSize);
  const auto at = [&](int panel) {
    const std::uint8_t* p = &map.data[3 * std::size_t(kSize / 2 * map.width + panel * kSize + 16)];
    return std::array<int, 3>{p[0], p[1], p[2]};
  };
  EXPECT_EQ(at(0), (std::array<int, 3>{103, 150, 100}));
  EXPECT_EQ(at(1), (std::array<int, 3>{100, 150, 30}));
  EXPECT_EQ(at(2), (std::array<int, 3>{128 - 4 * 3, 128, 0})) << "clamped";
  settings.error_map = [](int, const Image&) -> Result<Done, InputError> {
    return InputError{Errc::kUnwritable, "full"};
  };
  EXPECT_FALSE(evaluate(maps, capture_, std::vector{0}, settings));
}

TEST(QualityGapTest, SharesSumToOneAndSayWhichStepLost) {
  Quality unquantised, coded;
  unquantised.points.push_back({10, 30, 0, {}, 1});
  coded.points.push_back({10, 29, 0, {}, 1});
  unquantised.image.psnr = 30 - 10 * std::log10(2);  // splatting doubles the squared error
  coded.image.psnr = 30 - 10 * std::log10(4);        // and quantisation doubles it again
  coded.image.uncovered_error_share = 0.2;
  const QualityGap gap = quality_gap(unquantised, coded);
  EXPECT_NEAR(gap.coverage, 0.2, 1e-12);
  EXPECT_NEAR(gap.points, 0.2, 1e-12);
  EXPECT_NEAR(gap.splatting, 0.2, 1e-12);
  EXPECT_NEAR(gap.quantisation, 0.4, 1e-12);
  unquantised.image.psnr = 31;  // pictures that are better than points
  EXPECT_LT(quality_gap(unquantised, coded).splatting, 0);
}

}  // namespace
}  // namespace slf::evaluate_pictures_test
