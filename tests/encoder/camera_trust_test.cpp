// SPDX-License-Identifier: Apache-2.0
// Photographs that do not belong, one badly posed, one overexposed: the fit is no worse for them.
#include "slf/camera_trust.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>

#include "encoder/fit/sampled_sight.h"
#include "encoder/fit_capture.h"
#include "lightfield/colour.h"
#include "slf/decoder.h"
#include "slf/encoder.h"
#include "slf/evaluate.h"
#include "tools/synth/synth.h"

namespace slf::camera_trust_test {
namespace {

constexpr int kBits = 6;

/// A can from 50 cameras, 13 of them held out.
class CameraTrustTest : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    root_ = std::filesystem::path(testing::TempDir()) /
            ("slf_camera_trust_" + std::to_string(getpid()));
    std::filesystem::remove_all(root_);
    synth::SynthSettings settings;
    settings.scene = "can";
    settings.width = settings.height = 96;
    settings.circles = 5;
    settings.per_circle = 10;
    settings.points = 8000;
    const auto made = synth::synthesise(settings, root_, {});
    ASSERT_TRUE(made) << made.error().message;
    auto capture = load_capture(root_);
    ASSERT_TRUE(capture) << capture.error().message;
    std::vector<Image> images;
    for (std::size_t i = 0; i < capture->cameras.size(); ++i) {
      images.push_back(*load_image(*capture, static_cast<int>(i)));
      (i % 4 == 3 ? held_out_ : input_).push_back(static_cast<int>(i));
    }
    capture->images = std::move(images);
    capture_ = *std::move(capture);
  }
  static void TearDownTestSuite() { std::filesystem::remove_all(root_); }

  static EncoderSettings settings() {
    EncoderSettings s = settings_of(Preset::kDefault, 4);
    s.surface = Surface::kGiven;
    s.grid_bits = kBits;
    s.q = 4;
    return s;
  }

  static Result<std::vector<CameraTrust>, InputError> check(const Capture& capture,
                                                            const std::vector<int>& cameras,
                                                            int threads = 0) {
    SLF_TRY(const Observations seen, observed(capture, cameras));
    return check_cameras(seen, threads);
  }

  static Result<Observations, InputError> observed(const Capture& capture,
                                                   const std::vector<int>& cameras) {
    SLF_TRY(const VoxelCloud cloud, voxelise_capture(capture, cameras, settings()));
    ObservedPoints points;
    for (const Voxel& v : cloud.positions) {
      const Vec3 w = cloud.grid.world(v);
      points.positions.push_back({float(w[0]), float(w[1]), float(w[2])});
    }
    points.normals = cloud.normals;
    return observe(capture, cameras, points, points.positions, cloud.grid.step, {});
  }

  /// PSNR of the undisturbed held-out cameras, dB.
  struct Quality {
    double points = 0, pictures = 0;
  };
  static Quality held_out_psnr(const Capture& capture, const std::vector<int>& cameras,
                               const EncoderSettings& s) {
    const auto encoded = encode(capture, cameras, s);
    EXPECT_TRUE(encoded) << encoded.error().message;
    if (!encoded) return {};
    const auto field = decode(encoded->stream);
    EXPECT_TRUE(field);
    const auto evaluation = evaluate(ViewMaps(*field), capture_, held_out_, {});
    return {evaluation->points[0].psnr, evaluation->image.psnr};
  }

  static std::vector<int> without(std::vector<int> cameras, const std::vector<int>& some) {
    std::erase_if(cameras, [&](int c) { return std::count(some.begin(), some.end(), c) > 0; });
    return cameras;
  }

  static inline std::filesystem::path root_;
  static inline Capture capture_;
  static inline std::vector<int> input_, held_out_;
};

/// A different exposure, in linear light, clipped.
void expose(Image& image, double factor) {
  for (std::uint8_t& v : image.data) {
    const double linear = std::min(factor * srgb_to_linear(v / 255.0), 1.0);
    v = static_cast<std::uint8_t>(std::lround(255 * linear_to_srgb(linear)));
  }
}

/// The camera turned about its vertical axis.
void turn(Camera& camera, double degrees) {
  const double angle = degrees * 3.14159265358979323846 / 180;
  const double c = std::cos(angle), s = std::sin(angle);
  const auto r = camera.rotation;
  const Vec3 t = camera.translation;
  for (std::size_t k = 0; k < 3; ++k) {
    camera.rotation[0][k] = c * r[0][k] + s * r[2][k];
    camera.rotation[2][k] = c * r[2][k] - s * r[0][k];
  }
  camera.translation = {c * t[0] + s * t[2], t[1], c * t[2] - s * t[0]};
}

TEST_F(CameraTrustTest, EveryCameraOfAGoodCaptureIsKeptAndTheFileIsTheSame) {
  const auto trust = check(capture_, input_);
  ASSERT_TRUE(trust) << trust.error().message;
  ASSERT_EQ(trust->size(), input_.size());
  for (const CameraTrust& t : *trust) {
    EXPECT_EQ(t.verdict, CameraVerdict::kKept) << t.camera << ": " << reason_of(t);
    EXPECT_GT(t.agreement, 0.65) << t.camera;
    EXPECT_EQ(reason_of(t), "");
  }
  EXPECT_EQ(trusted_cameras(*trust), input_);
  EXPECT_TRUE(foreign_photographs(capture_, capture_.cloud, input_, 0)->empty());
  EncoderSettings off = settings();
  off.check_cameras = false;
  const auto checked = encode(capture_, input_, settings()),
             unchecked = encode(capture_, input_, off);
  ASSERT_TRUE(checked && unchecked);
  EXPECT_EQ(checked->stream, unchecked->stream);
  EXPECT_EQ(checked->cameras.size(), input_.size());
  EXPECT_TRUE(unchecked->cameras.empty());
}

struct Disturbance {
  const char* name;
  std::vector<int> cameras;  ///< positions in the list of input cameras
  CameraVerdict verdict;
  std::function<void(Capture&, int camera)> apply;
};
void PrintTo(const Disturbance& disturbance, std::ostream* out) { *out << disturbance.name; }

class DisturbedCapture : public CameraTrustTest, public testing::WithParamInterface<Disturbance> {};

TEST_P(DisturbedCapture, IsFoundAndTheFitIsNoWorseThanWithoutIt) {
  Capture capture = capture_;
  std::vector<int> bad;
  for (const int at : GetParam().cameras) bad.push_back(input_[std::size_t(at)]);
  for (const int camera : bad) GetParam().apply(capture, camera);
  const auto trust = check(capture, input_);
  ASSERT_TRUE(trust) << trust.error().message;
  for (const CameraTrust& t : *trust) {
    const bool is_bad = std::count(bad.begin(), bad.end(), t.camera) > 0;
    EXPECT_EQ(t.verdict, is_bad ? GetParam().verdict : CameraVerdict::kKept)
        << t.camera << ": " << reason_of(t);
    EXPECT_EQ(reason_of(t).empty(), !is_bad);
  }
  const auto foreign = foreign_photographs(capture, capture.cloud, input_, 0);
  ASSERT_TRUE(foreign) << foreign.error().message;
  std::vector<int> left_out;
  for (const CameraTrust& t : *foreign) left_out.push_back(t.camera);
  EXPECT_EQ(left_out, GetParam().verdict == CameraVerdict::kDropped ? bad : std::vector<int>{});
  EncoderSettings off = settings();
  off.check_cameras = false;
  const Quality with = held_out_psnr(capture, input_, settings());
  const Quality without_it = held_out_psnr(capture, without(input_, bad), off);
  const Quality unchecked = held_out_psnr(capture, input_, off);
  std::printf("points %.3f, without %.3f, unchecked %.3f dB; pictures %.3f, %.3f, %.3f dB\n",
              with.points, without_it.points, unchecked.points, with.pictures, without_it.pictures,
              unchecked.pictures);
  EXPECT_GT(with.points, without_it.points - 0.1);
  EXPECT_GT(with.pictures, without_it.pictures - 0.1);
  EXPECT_LT(unchecked.points, with.points);
}

INSTANTIATE_TEST_SUITE_P(
    , DisturbedCapture,
    testing::Values(Disturbance{"photograph_of_another_side",
                                {7},
                                CameraVerdict::kDropped,
                                [](Capture& c, int i) {
                                  c.images[std::size_t(i)] = c.images[(std::size_t(i) + 5) % 50];
                                }},
                    Disturbance{"three_photographs_that_do_not_belong",
                                {3, 14, 30},
                                CameraVerdict::kDropped,
                                [](Capture& c, int i) {
                                  std::reverse(c.images[std::size_t(i)].data.begin(),
                                               c.images[std::size_t(i)].data.end());
                                }},
                    Disturbance{"one_badly_posed",
                                {18},
                                CameraVerdict::kDropped,
                                [](Capture& c, int i) { turn(c.cameras[std::size_t(i)], 2); }},
                    Disturbance{"one_overexposed",
                                {18},
                                CameraVerdict::kGainCorrected,
                                [](Capture& c, int i) { expose(c.images[std::size_t(i)], 1.6); }},
                    Disturbance{"one_underexposed",
                                {9},
                                CameraVerdict::kGainCorrected,
                                [](Capture& c, int i) { expose(c.images[std::size_t(i)], 0.5); }},
                    Disturbance{"one_burnt_out",
                                {18},
                                CameraVerdict::kDropped,
                                [](Capture& c, int i) { expose(c.images[std::size_t(i)], 20); }}),
    [](const auto& instance) { return instance.param.name; });

TEST_F(CameraTrustTest, ACloudThatNoPhotographSupportsIsRefused) {
  Capture capture = capture_;
  for (std::size_t i = 0; i < capture.images.size(); ++i)
    capture.images[i] = capture_.images[(i * 23 + 11) % capture.images.size()];
  const auto encoded = encode(capture, input_, settings());
  ASSERT_FALSE(encoded);
  EXPECT_EQ(encoded.error().code, Errc::kInvalidInput);
  EXPECT_NE(encoded.error().message.find("no photograph supports the cloud"), std::string::npos)
      << encoded.error().message;
  EncoderSettings off = settings();
  off.check_cameras = false;
  EXPECT_TRUE(encode(capture, input_, off));
}

TEST_F(CameraTrustTest, NoneOfTheCamerasThereAreIsRefusedAndNotTakenForACloudOfColours) {
  const auto encoded = encode(capture_, {}, settings());
  ASSERT_FALSE(encoded);
  EXPECT_EQ(encoded.error().code, Errc::kInvalidArgument);
}

TEST_F(CameraTrustTest, FewerThanFourCamerasAreNotJudged) {
  Capture capture = capture_;
  expose(capture.images[std::size_t(input_[1])], 4);
  const auto trust = check(capture, {input_[0], input_[1], input_[2]});
  ASSERT_TRUE(trust) << trust.error().message;
  for (const CameraTrust& t : *trust) EXPECT_EQ(t.verdict, CameraVerdict::kKept);
}

TEST_F(CameraTrustTest, VerdictsAreTheSameForAnyThreadCount) {
  Capture capture = capture_;
  turn(capture.cameras[std::size_t(input_[4])], 2);
  expose(capture.images[std::size_t(input_[20])], 1.5);
  std::vector<std::vector<CameraTrust>> all;
  for (const int threads : {1, 2, 5}) all.push_back(*check(capture, input_, threads));
  for (const auto& other : all)
    for (std::size_t i = 0; i < other.size(); ++i) {
      EXPECT_EQ(other[i].verdict, all[0][i].verdict);
      EXPECT_EQ(other[i].agreement, all[0][i].agreement);
      EXPECT_EQ(other[i].gain, all[0][i].gain);
    }
}

TEST_F(CameraTrustTest, WhatIsLeftAreTheObservationsOfTheOthers) {
  const auto seen = observed(capture_, input_);
  ASSERT_TRUE(seen);
  std::vector<CameraTrust> trust(2);
  trust[0].camera = input_[2];
  trust[0].verdict = CameraVerdict::kDropped;
  trust[1].camera = input_[5];
  trust[1].verdict = CameraVerdict::kGainCorrected;
  trust[1].gain = {0.5f, 1, 1.25f};
  const Observations left = trusted_observations(*seen, trust);
  ASSERT_EQ(left.first.size(), seen->first.size());
  ASSERT_EQ(left.first.back(), left.colour.size());
  ASSERT_EQ(left.camera.size(), left.colour.size());
  ASSERT_EQ(left.direction.size(), left.colour.size());
  std::size_t at = 0;
  for (std::size_t i = 0; i < seen->colour.size(); ++i) {
    if (seen->camera[i] == input_[2]) continue;
    auto colour = seen->colour[i];
    if (seen->camera[i] == input_[5]) {
      if (std::max({colour[0], colour[1], colour[2]}) >= 253) continue;
      colour = {colour[0] * 0.5f, colour[1], std::min(colour[2] * 1.25f, 255.0f)};
    }
    ASSERT_LT(at, left.colour.size());
    EXPECT_EQ(left.colour[at], colour);
    EXPECT_EQ(left.direction[at], seen->direction[i]);
    ++at;
  }
  EXPECT_EQ(at, left.colour.size());
  EXPECT_EQ(trusted_observations(*seen, {}).colour, seen->colour);
}

}  // namespace
}  // namespace slf::camera_trust_test
