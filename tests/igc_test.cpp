// Image-plus-geometry coding on a small synthetic capture. Paper IV-F.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include "igc/camera_walk.h"
#include "igc/igc_file.h"
#include "igc/ycbcr.h"
#include "slf/decoder.h"
#include "slf/evaluate.h"
#include "slf/igc.h"
#include "slf/view_map.h"
#include "tests/video_support.h"
#include "tools/synth/synth.h"

namespace slf {
namespace {

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
    s.slf.refine_geometry = RefineGeometry::kOff;
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
  EXPECT_TRUE(has("penalise_dc", "1"));
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

TEST_F(Igc, DamageIsAnError) {
  SLF_NEEDS_HEVC();
  const std::vector<std::uint8_t> whole = encoded(settings(40)).stream;
  const Capture bare = calibration();
  EXPECT_TRUE(is_igc(whole));
  for (std::size_t size = 0; size < whole.size(); size += size < 64 ? 1 : 331)
    EXPECT_FALSE(decode_igc(std::span(whole).first(size), bare)) << size << " bytes";
  for (std::size_t at = 0; at < whole.size(); at += at < 64 ? 1 : 331) {
    std::vector<std::uint8_t> damaged = whole;
    damaged[at] ^= 0x20;
    EXPECT_FALSE(decode_igc(damaged, bare)) << "byte " << at;
  }
  std::vector<std::uint8_t> longer = whole;
  longer.push_back(0);
  EXPECT_EQ(decode_igc(longer, bare).error().code, Errc::kOutOfRange);
  EXPECT_EQ(decode_igc({}, bare).error().code, Errc::kNotSlf);
}

TEST_F(Igc, SectionsThatDoNotFitTogetherAreRefused) {
  SLF_NEEDS_HEVC();
  const auto a = encoded(settings(40)).stream, b = encoded(settings(40, IgcChroma::k444)).stream;
  const IgcSections one = *read_igc_file(a), other = *read_igc_file(b);
  const auto refused = [](IgcSections sections) {
    return !decode_igc(write_igc_file(sections), calibration());
  };
  EXPECT_FALSE(refused(one));
  EXPECT_TRUE(refused({one.parameters, one.geometry, other.images}));  // other chroma
  EXPECT_TRUE(refused({one.parameters, one.images, one.geometry}));    // swapped
  EXPECT_TRUE(refused({{}, one.geometry, one.images}));
  EXPECT_TRUE(refused({one.parameters, one.geometry, {}}));
}

TEST_F(Igc, TheCamerasOfTheFileMustBeTheCaptures) {
  SLF_NEEDS_HEVC();
  const auto stream = encoded(settings(40)).stream;
  Capture renamed = calibration(), resized = calibration(), none;
  renamed.cameras[static_cast<std::size_t>(cameras_[0])].name = "another";
  resized.cameras[static_cast<std::size_t>(cameras_[0])].width += 1;
  for (const Capture& capture : {renamed, resized, none})
    EXPECT_EQ(decode_igc(stream, capture).error().code, Errc::kInvalidInput);
  IgcDecodeOptions options;
  options.limits.max_output_bytes = 100000;
  EXPECT_EQ(decode_igc(stream, capture_, options).error().code, Errc::kLimitExceeded);
}

TEST_F(Igc, WhatCannotBeEncodedIsRefused) {
  Capture uneven = capture_;
  uneven.cameras[static_cast<std::size_t>(cameras_[3])].width = 80;
  const auto mixed = encode_igc(uneven, cameras_, settings(30));
  ASSERT_FALSE(mixed);
  EXPECT_NE(
      mixed.error().message.find(capture_.cameras[static_cast<std::size_t>(cameras_[3])].name),
      std::string::npos);
  EXPECT_FALSE(encode_igc(capture_, {}, settings(30)));
  EXPECT_FALSE(encode_igc(capture_, std::vector{9999}, settings(30)));
  SLF_NEEDS_HEVC();
  EXPECT_FALSE(encode_igc(capture_, cameras_, settings(60)));
  Capture missing = capture_;
  missing.image_files[static_cast<std::size_t>(cameras_[2])] = "/nowhere/image.png";
  EXPECT_EQ(encode_igc(missing, cameras_, settings(30)).error().code, Errc::kUnreadable);
  Capture names = capture_;
  names.cameras[static_cast<std::size_t>(cameras_[0])].name = "two\nlines";
  EXPECT_EQ(encode_igc(names, cameras_, settings(30)).error().code, Errc::kInvalidArgument);
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

TEST(Ycbcr, BackAndForthStaysWithinTheRounding) {
  Image image{7, 5, 3, {}};
  for (int i = 0; i < 7 * 5 * 3; ++i) image.data.push_back(static_cast<std::uint8_t>(i * 37 % 256));
  const Image back = to_rgb(to_ycbcr(image, IgcChroma::k444), 7, 5);
  ASSERT_EQ(back.data.size(), image.data.size());
  for (std::size_t i = 0; i < image.data.size(); ++i)
    EXPECT_NEAR(back.data[i], image.data[i], 3) << "sample " << i;
}

TEST(Ycbcr, AnEvenColourSurvivesHalvedChromaOfAnOddSize) {
  Image image{7, 5, 4, {}};
  for (int i = 0; i < 7 * 5; ++i) image.data.insert(image.data.end(), {200, 40, 90, 255});
  const Picture picture = to_ycbcr(image, IgcChroma::k420);
  EXPECT_EQ(picture.width, 8);
  EXPECT_EQ(picture.planes[1].size(), 4u * 3);
  const Image back = to_rgb(picture, 7, 5);
  for (std::size_t i = 0; i < back.data.size(); ++i)
    EXPECT_NEAR(back.data[i], image.data[i % 3], 2) << "sample " << i;
}

TEST(Ycbcr, ChromaIsInterpolatedAtTheRightPlaces) {
  // A ramp of blue differences: bilinear interpolation of the means of pairs gives it back inside.
  Image image{16, 2, 3, {}};
  for (int y = 0; y < 2; ++y)
    for (int x = 0; x < 16; ++x)
      for (const int value : {100, 100, 100 + 4 * x})
        image.data.push_back(static_cast<std::uint8_t>(value));
  const Image back = to_rgb(to_ycbcr(image, IgcChroma::k420), 16, 2);
  for (std::size_t x = 1; x < 15; ++x)
    EXPECT_NEAR(back.data[3 * x + 2], 100 + 4 * static_cast<double>(x), 2) << "pixel " << x;
}

}  // namespace
}  // namespace slf
