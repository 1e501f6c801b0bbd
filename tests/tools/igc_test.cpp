// SPDX-License-Identifier: Apache-2.0
// Image-plus-geometry coding on a small synthetic capture. Paper IV-F.
#include <algorithm>
#include <numeric>

#include "igc_support.h"
#include "tools/rd/igc/camera_walk.h"

namespace slf::igc_test {
namespace {

using test::Igc;

TEST_F(Igc, ACaptureFarFromZeroHasTheSameFieldFarFromZero) {
  SLF_NEEDS_HEVC();
  Capture far = capture_;
  far.origin = {400000, 5700000, 100};
  const auto near_file = encode_igc(capture_, cameras_, settings(22));
  const auto far_file = encode_igc(far, cameras_, settings(22));
  ASSERT_TRUE(near_file && far_file);
  const auto near_field = decode_igc(near_file->stream, capture_);
  const auto far_field = decode_igc(far_file->stream, far);
  ASSERT_TRUE(near_field && far_field);
  const LightField &a = near_field->light_field, &b = far_field->light_field;
  EXPECT_EQ(a.positions, b.positions);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(b.header.grid.origin[k] - far.origin[k], a.header.grid.origin[k], 1e-8);
    EXPECT_EQ(b.header.grid.origin[k], far_file->grid.origin[k]);
  }
  EvaluateSettings evaluation;
  evaluation.images = false;
  const auto quality = evaluate(ViewMaps(b), far, cameras_, evaluation);
  ASSERT_TRUE(quality);
  EXPECT_NEAR(quality->points[0].psnr, psnr(a), 0.01);
}

TEST_F(Igc, FinelyCodedImagesGiveTheFitOfTheOriginals) {
  SLF_NEEDS_HEVC();
  // Both estimate normals from the same points: the centres of the voxels.
  Capture capture = capture_;
  const auto voxels = voxelise(capture_.cloud, 6);
  ASSERT_TRUE(voxels) << voxels.error().message;
  capture.cloud = {};
  for (const Voxel& v : voxels->positions) {
    const Vec3 w = voxels->grid.world(v);
    capture.cloud.positions.push_back(
        {static_cast<float>(w[0]), static_cast<float>(w[1]), static_cast<float>(w[2])});
  }
  EncoderSettings slf = settings(0).slf;
  slf.q = 0.05;
  const auto direct = encode(capture, cameras_, slf);
  ASSERT_TRUE(direct) << direct.error().message;
  const auto field = decode(direct->stream);
  const auto igc = decode_igc(encoded(settings(2, IgcChroma::k444)).stream, capture_);
  ASSERT_TRUE(igc) << igc.error().message;
  EXPECT_EQ(igc->light_field.positions, field->positions);
  EXPECT_EQ(igc->light_field.header.basis, field->header.basis);
  EXPECT_EQ(igc->light_field.header.up, field->header.up);
  EXPECT_EQ(igc->light_field.header.gamma_min_q7, field->header.gamma_min_q7);
  EXPECT_NEAR(psnr(igc->light_field), psnr(*field), 0.05);
}

TEST_F(Igc, ThePaperPresetReachesTheDecoder) {
  SLF_NEEDS_HEVC();
  IgcSettings s = settings(20);
  s.slf = settings_of(Preset::kPaper);
  s.slf.grid_bits = 6;
  s.slf.fit.iterations = 1;
  const auto igc = decode_igc(encoded(s).stream, capture_);
  ASSERT_TRUE(igc) << igc.error().message;
  EXPECT_EQ(igc->light_field.header.colour, ColourTransform::kNone);
  const auto has = [&](const char* key, const char* value) {
    return std::count(igc->metadata.begin(), igc->metadata.end(),
                      std::pair<std::string, std::string>(key, value)) == 1;
  };
  EXPECT_TRUE(has("penalise-dc", "on"));
  EXPECT_TRUE(has("iterations", "1"));
  EXPECT_TRUE(has("lambda", "0.8"));
  EXPECT_TRUE(has("qp", "20"));
}

TEST_F(Igc, MetadataComesBackUnderItsOwnKeys) {
  SLF_NEEDS_HEVC();
  IgcSettings s = settings(40);
  s.slf.metadata = {{"split", "sparse"}, {"note", "a=b"}};
  const auto igc = decode_igc(encoded(s).stream, capture_);
  ASSERT_TRUE(igc) << igc.error().message;
  for (const auto& pair : s.slf.metadata)
    EXPECT_EQ(std::count(igc->metadata.begin(), igc->metadata.end(), pair), 1) << pair.first;
}

TEST_F(Igc, ACoarserQpIsSmallerAndWorse) {
  SLF_NEEDS_HEVC();
  const IgcEncoded fine = encoded(settings(22)), coarse = encoded(settings(42));
  EXPECT_LT(2 * coarse.bytes_images, fine.bytes_images);
  EXPECT_LT(decoded_psnr(coarse) + 1, decoded_psnr(fine));
  EXPECT_EQ(fine.bytes_parameters + fine.bytes_geometry + fine.bytes_images, fine.stream.size());
}

TEST_F(Igc, PredictionFromNeighboursIsSmallerThanIntra) {
  SLF_NEEDS_HEVC();
  IgcSettings intra = settings(32);
  intra.codec = IgcCodec::kHevcIntra;
  EXPECT_LT(encoded(settings(32)).bytes_images, encoded(intra).bytes_images);
  EXPECT_GT(decoded_psnr(encoded(intra)), 20);
}

TEST_F(Igc, Av1IsTheSameJourney) {
  SLF_NEEDS_AV1();
  IgcSettings s = settings(20, IgcChroma::k444);
  s.codec = IgcCodec::kAv1;
  s.speed = "8";
  const IgcEncoded fine = encoded(s);
  s.qp = 55;
  s.chroma = IgcChroma::k420;
  const IgcEncoded coarse = encoded(s);
  EXPECT_LT(coarse.bytes_images, fine.bytes_images);
  EXPECT_LT(decoded_psnr(coarse) + 0.5, decoded_psnr(fine));
}

TEST_F(Igc, TheDecoderReadsNoImagesAndNoPoints) {
  SLF_NEEDS_HEVC();
  const IgcEncoded e = encoded(settings(30));
  const auto there = decode_igc(e.stream, capture_), bare = decode_igc(e.stream, calibration());
  ASSERT_TRUE(bare) << bare.error().message;
  EXPECT_EQ(bare->light_field.components, there->light_field.components);
}

TEST_F(Igc, ResultsDoNotDependOnThreads) {
  SLF_NEEDS_HEVC();
  IgcSettings s = settings(30);
  s.slf.threads = 1;
  const IgcEncoded one = encoded(s);
  s.slf.threads = 3;
  EXPECT_EQ(encoded(s).stream, one.stream);
  IgcDecodeOptions options;
  options.threads = 1;
  const auto a = decode_igc(one.stream, capture_, options);
  options.threads = 3;
  EXPECT_EQ(decode_igc(one.stream, capture_, options)->light_field.components,
            a->light_field.components);
}

TEST_F(Igc, TheWalkVisitsEveryCameraOnceAndIsNoLongerThanTheGivenOrder) {
  std::vector<int> shuffled;  // a fixed, bad order
  for (std::size_t i = 0; i < cameras_.size(); ++i)
    shuffled.push_back(cameras_[i * 7 % cameras_.size()]);
  ASSERT_NE(cameras_.size() % 7, 0u);
  for (const auto& given : {cameras_, shuffled, std::vector<int>{4}, std::vector<int>{7, 2}}) {
    const std::vector<int> walk = camera_walk(capture_, given);
    std::vector<int> sorted = walk, places(given.size());
    std::iota(places.begin(), places.end(), 0);
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, places);
    EXPECT_EQ(walk.front(), 0);
    const ViewDistance distance(capture_, given);
    EXPECT_LE(walk_length(distance, walk), walk_length(distance, places));
    if (given != shuffled) continue;
    EXPECT_LT(1.5 * walk_length(distance, walk), walk_length(distance, places));
  }
}

}  // namespace
}  // namespace slf::igc_test
