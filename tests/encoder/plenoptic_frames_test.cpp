// SPDX-License-Identifier: Apache-2.0
// Clouds of views as frames in time: what comes back, what prediction saves, what is refused.
#include <gmock/gmock.h>

#include <algorithm>

#include "plenoptic_support.h"
#include "slf/decoder.h"
#include "slf/plenoptic_frames.h"

namespace slf::plenoptic_frames_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using Clouds = std::vector<PlenopticCloud>;
using test::sphere_of_views;
using testing::HasSubstr;

struct Coded {
  EncodedFrames report;
  Bytes stream;
  std::string error;
};

Coded code(const Clouds& clouds, const PlenopticSettings& settings = {},
           const FrameSettings& frame_settings = {}) {
  Coded out;
  auto encoded = encode_plenoptic_frames(
      clouds.size(), [&](std::size_t f) { return Result<PlenopticCloud, InputError>(clouds[f]); },
      settings, frame_settings,
      [&](std::size_t, std::span<const std::uint8_t> bytes) {
        out.stream.insert(out.stream.end(), bytes.begin(), bytes.end());
        return Result<Done, InputError>(Done{});
      });
  if (encoded)
    out.report = *std::move(encoded);
  else
    out.error = encoded.error().message;
  return out;
}

PlenopticSettings with_step(double q) {
  PlenopticSettings settings;
  settings.encoder.q = q;
  return settings;
}

Clouds decoded(const Bytes& stream) {
  Clouds clouds;
  const Metadata metadata = read_info(stream)->metadata;
  auto decoder = FrameDecoder::open(stream);
  EXPECT_TRUE(decoder);
  for (std::size_t f = 0; f < decoder->frames().size(); ++f) {
    const FrameInfo& info = decoder->frames()[f];
    const auto field = decoder->decode(f);
    EXPECT_TRUE(field) << to_string(field.error());
    const auto bytes = std::span(stream).subspan(std::size_t(info.offset), std::size_t(info.bytes));
    std::vector<std::string> warnings;
    auto cloud = decode_plenoptic(bytes, *field, metadata, &warnings);
    EXPECT_TRUE(cloud) << cloud.error().message;
    EXPECT_TRUE(warnings.empty()) << warnings[0];
    clouds.push_back(*std::move(cloud));
  }
  return clouds;
}

/// The sphere moves along x, a voxel a frame.
Clouds moving(std::size_t frames, std::size_t views = 4, bool own_mean = true) {
  Clouds clouds;
  for (std::size_t f = 0; f < frames; ++f) {
    PlenopticCloud cloud = sphere_of_views(views, 1, own_mean);
    cloud.grid.origin = {double(f), 0, 0};
    const auto moved = on_grid_of_voxels(cloud, Grid{.bits = 6});
    EXPECT_TRUE(moved);
    clouds.push_back(*moved);
  }
  return clouds;
}

double least_psnr(const Clouds& a, const Clouds& b) {
  double least = 1000;
  for (std::size_t f = 0; f < a.size(); ++f) {
    const auto quality = measure_plenoptic(a[f], b[f]);
    EXPECT_TRUE(quality) << quality.error().message;
    for (const ViewQuality& view : quality->views) least = std::min(least, view.yuv[0]);
  }
  return least;
}

TEST(PlenopticFrames, GiveBackEveryByteAndEveryProperty) {
  for (const bool mean : {true, false}) {
    const Clouds clouds = moving(3, 5, mean);
    const Coded coded = code(clouds);
    ASSERT_EQ(coded.error, "");
    EXPECT_TRUE(coded.report.exact);
    EXPECT_TRUE(coded.report.frames[1].predicted);
    const Clouds back = decoded(coded.stream);
    ASSERT_EQ(back.size(), 3u);
    for (std::size_t f = 0; f < 3; ++f) {
      EXPECT_EQ(back[f].positions, clouds[f].positions);
      EXPECT_EQ(back[f].colours, clouds[f].colours);
      EXPECT_EQ(back[f].properties, clouds[f].properties);
      EXPECT_EQ(back[f].view_positions, clouds[f].view_positions);
    }
  }
}

TEST(PlenopticFrames, AreExactAlsoWhereOneOwnColourIsNoMean) {
  Clouds clouds = {sphere_of_views(3), sphere_of_views(3, 1, false)};
  const Clouds back = decoded(code(clouds).stream);
  EXPECT_EQ(back[0].colours, clouds[0].colours);
  EXPECT_EQ(back[1].colours, clouds[1].colours);
}

TEST(PlenopticFrames, WithAStepStillOnesAreNearlyFreeAndMovingOnesPay) {
  const Coded still = code(Clouds(3, sphere_of_views(4)), with_step(4));
  ASSERT_EQ(still.error, "");
  EXPECT_LT(still.report.frames[2].bytes * 8, still.report.frames[0].bytes);
  const Clouds clouds = moving(3);
  FrameSettings intra;
  intra.group = 1;
  const Coded predicted = code(clouds, with_step(8)), alone = code(clouds, with_step(8), intra);
  EXPECT_LT(predicted.report.frames[2].bytes * 3, alone.report.frames[2].bytes * 2);
  EXPECT_GT(least_psnr(decoded(predicted.stream), clouds), 38);
}

TEST(PlenopticFrames, AreTheSameForAnyThreadCountAndAnyParts) {
  const Clouds clouds = moving(4, 3);
  FrameSettings frames;
  frames.group = 2;
  frames.hold_over_groups = false;
  for (const double q : {0.0, 6.0}) {
    PlenopticSettings settings;
    if (q > 0) settings.encoder.q = q;
    settings.encoder.threads = 1;
    const Bytes whole = code(clouds, settings, frames).stream;
    settings.encoder.threads = 3;
    EXPECT_EQ(code(clouds, settings, frames).stream, whole);
    Bytes joined;
    FrameSettings part = frames;
    for (part.parts = 2, part.part = 0; part.part < 2; ++part.part) {
      const Bytes bytes = code(clouds, settings, part).stream;
      joined.insert(joined.end(), bytes.begin(), bytes.end());
    }
    EXPECT_EQ(joined, whole);
  }
}

TEST(PlenopticFrames, MayHaveNoPoints) {
  Clouds clouds = moving(2, 3);
  clouds.insert(clouds.begin() + 1, PlenopticCloud{});
  clouds.insert(clouds.begin(), PlenopticCloud{});
  for (const PlenopticSettings& settings : {PlenopticSettings{}, with_step(4)}) {
    const Coded coded = code(clouds, settings);
    ASSERT_EQ(coded.error, "");
    const Clouds back = decoded(coded.stream);
    ASSERT_EQ(back.size(), 4u);
    EXPECT_EQ(back[0].num_points(), 0u);
    EXPECT_EQ(back[2].num_points(), 0u);
    EXPECT_EQ(back[2].properties, clouds[1].properties);
    EXPECT_EQ(back[3].positions, clouds[3].positions);
  }
  EXPECT_THAT(code({PlenopticCloud{}}).error, HasSubstr("none has points"));
}

TEST(PlenopticFrames, HaveOneGridWhereverTheirsBegin) {
  Clouds clouds = {sphere_of_views(3), sphere_of_views(3)};
  clouds[1].grid.origin = {-4, 2, 0};
  const Coded coded = code(clouds);
  ASSERT_EQ(coded.error, "");
  const Clouds back = decoded(coded.stream);
  EXPECT_EQ(back[0].grid.origin, (Vec3{6, 10, 10}));
  for (std::size_t f = 0; f < 2; ++f) {
    const auto expected = on_grid_of_voxels(clouds[f], coded.report.grid);
    ASSERT_TRUE(expected);
    EXPECT_EQ(back[f].positions, expected->positions);
    EXPECT_EQ(back[f].colours, expected->colours);
    EXPECT_EQ(back[f].grid.world(back[f].positions[0]),
              expected->grid.world(expected->positions[0]));
  }
}

TEST(PlenopticFrames, WithOtherViewsOrVoxelsAreRefusedByTheirPlace) {
  const auto error_of = [](const PlenopticCloud& second) {
    return code({sphere_of_views(3), second}).error;
  };
  EXPECT_THAT(error_of(sphere_of_views(4)), HasSubstr("frame 1: 4 views"));
  PlenopticCloud cloud = sphere_of_views(3);
  cloud.properties[7].name = "other";
  EXPECT_THAT(error_of(cloud), HasSubstr("uchar other"));
  cloud = sphere_of_views(3);
  cloud.view_positions[0][0] += 1;
  EXPECT_THAT(error_of(cloud), HasSubstr("--views"));
  cloud = sphere_of_views(3);
  cloud.grid.step = 0.5;
  EXPECT_THAT(error_of(cloud), HasSubstr("another size"));
  cloud.grid.step = 1;
  cloud.grid.origin = {0.5, 0, 0};
  EXPECT_THAT(error_of(cloud), HasSubstr("between"));
}

TEST(PlenopticFrames, TakeABitrateInPlaceOfAStep) {
  const Clouds clouds = moving(6, 3);
  PlenopticSettings settings;
  settings.encoder.target_bitrate = 400000;
  const Coded coded = code(clouds, settings);
  ASSERT_EQ(coded.error, "");
  EXPECT_FALSE(coded.report.exact);
  const double bitrate = 8 * double(coded.stream.size()) * 30 / 6;
  EXPECT_LE(bitrate, 400000);
  EXPECT_GE(bitrate, 0.9 * 400000);
}

TEST(PlenopticFrames, AsViewMapsPredictTheViewsThatAreHeldOut) {
  const Clouds clouds = moving(3, 12);
  PlenopticSettings settings = with_step(4);
  settings.hold_out = {3, 7};
  settings.encoder.fit.basis.degree = 3;
  const Coded coded = code(clouds, settings);
  ASSERT_EQ(coded.error, "");
  EXPECT_EQ(coded.report.as, "viewmaps");
  EXPECT_TRUE(coded.report.frames[2].predicted);
  EXPECT_GT(least_psnr(decoded(coded.stream), clouds), 30);
  settings.as = PlenopticCoding::kPlanes;
  EXPECT_THAT(code(clouds, settings).error, HasSubstr("planes predict no"));
}

TEST(PlenopticFrames, ThatAreCutOutStayExact) {
  const Clouds clouds = moving(3);
  const Coded coded = code(clouds);
  const auto cut = truncate_frames(coded.stream, 0, 1, {});
  ASSERT_TRUE(cut);
  const Clouds back = decoded(*cut);
  ASSERT_EQ(back.size(), 2u);
  EXPECT_EQ(back[1].colours, clouds[1].colours);
}

}  // namespace
}  // namespace slf::plenoptic_frames_test
