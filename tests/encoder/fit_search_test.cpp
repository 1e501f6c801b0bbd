// SPDX-License-Identifier: Apache-2.0
// Cross-validation of the hierarchical fit: choose_fit of slf/fit.h, on scenes whose answer is
// known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "encoder/check_settings.h"
#include "encoder/fit/camera_folds.h"
#include "encoder/fit/environment_fit.h"
#include "encoder/fit_capture.h"
#include "lightfield/directions.h"
#include "slf/encoder.h"
#include "slf/fit.h"
#include "tests/codec/field_support.h"

namespace slf::fit_search_test {
namespace {

/// A sphere, and far cameras all around: those in front of a point see it.
struct Scene {
  std::vector<Voxel> positions = test::sphere_cloud(5);
  std::vector<std::array<float, 3>> normals =
      mirror_normals(Directions::kReflected, positions, 0, 1);

  /// @param shade  (direction of the view, reflected direction) -> grey
  template <class Shade>
  Observations observe(int cameras, const Shade& shade) const {
    const ObjectBox box(positions);
    std::mt19937 random(5);
    std::normal_distribution<float> noise(0, 1);
    Observations seen;
    seen.first.push_back(0);
    for (std::size_t p = 0; p < positions.size(); ++p) {
      const Vec3 at = box(positions[p]);
      for (int i = 0; i < cameras; ++i) {
        const double z = 1 - (2.0 * i + 1) / cameras, turn = 2.399963 * i;
        const Vec3 v{std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn),
                     z};
        if (at[0] * v[0] + at[1] * v[1] + at[2] * v[2] < 0.2) continue;
        const auto direction = direction_of(v);
        const float grey = shade(v, vector_of(to_local(normals, p, direction))) + noise(random);
        seen.direction.push_back(direction);
        seen.colour.push_back({grey, grey, grey});
        seen.camera.push_back(static_cast<std::uint16_t>(i));
      }
      seen.first.push_back(seen.direction.size());
    }
    return seen;
  }
};

/// One lobe of the reflected direction, the same all over the surface.
float mirror(const Vec3&, const Vec3& reflected) {
  return static_cast<float>(60 + 120 * std::exp(4 * (0.6 * reflected[0] + 0.8 * reflected[2] - 1)));
}

/// Colour by the view alone, as if each camera had its exposure: the normal does not matter.
float of_view(const Vec3& view, const Vec3&) {
  return static_cast<float>(100 + 60 * view[0] * view[1] + 40 * view[2]);
}

FitSettings settings_of(Directions frame) {
  FitSettings s;
  s.method = FitMethod::kHierarchical;
  s.basis = {BasisId::kHarmonics, 2, 0, 0, 3};
  s.directions = frame;
  s.environment.degree = 0;
  s.threads = 2;
  return s;
}

constexpr FitSearch kDirections{false, false, false, true, false};
constexpr FitSearch kAll{true, true, true, true, true};

TEST(FitSearch, TheFrameIsTheOneInWhichTheSurfaceIsAlike) {
  const Scene scene;
  const Observations shiny = scene.observe(24, mirror), flat = scene.observe(48, of_view);
  for (const Directions start : {Directions::kWorld, Directions::kReflected}) {
    const auto a = choose_fit(shiny, scene.positions, settings_of(start), kDirections);
    const auto b = choose_fit(flat, scene.positions, settings_of(start), kDirections);
    ASSERT_TRUE(a && b);
    EXPECT_EQ(a->outcome, ChosenFit::kSearched);
    EXPECT_EQ(a->settings.directions, Directions::kReflected);
    EXPECT_EQ(b->settings.directions, Directions::kWorld);
    EXPECT_EQ(a->psnr_chosen > a->psnr_given, start == Directions::kWorld);
    EXPECT_EQ(b->psnr_chosen > b->psnr_given, start == Directions::kReflected);
  }
}

TEST(FitSearch, AFrameThatGainsLittleIsNotWorthItsBytes) {
  const Scene scene;
  std::mt19937 random(9);
  std::normal_distribution<float> noise(0, 50);
  const Observations dull = scene.observe(
      24, [&](const Vec3& v, const Vec3& r) { return 0.3f * mirror(v, r) + noise(random); });
  const auto error = [&](Directions frame) {
    return choose_fit(dull, scene.positions, settings_of(frame), kDirections)->psnr_given;
  };
  EXPECT_GT(error(Directions::kReflected), error(Directions::kWorld));
  EXPECT_EQ(choose_fit(dull, scene.positions, settings_of(Directions::kWorld), kDirections)
                ->settings.directions,
            Directions::kWorld);
}

TEST(FitSearch, WhatIsNotSearchedStays) {
  const Scene scene;
  const auto chosen =
      choose_fit(scene.observe(24, of_view), scene.positions, settings_of(Directions::kReflected),
                 {true, true, true, false, false});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->settings.directions, Directions::kReflected);
  EXPECT_EQ(chosen->settings.basis, settings_of(Directions::kReflected).basis);
  const auto off = choose_fit(scene.observe(24, of_view), scene.positions,
                              settings_of(Directions::kReflected), FitSearch::none());
  EXPECT_EQ(off->outcome, ChosenFit::kNothingToSearch);
  EXPECT_EQ(off->settings.hierarchy.strength, HierarchySettings{}.strength);
}

TEST(FitSearch, NoiseWithoutDirectionRaisesThePenalties) {
  const Scene scene;
  std::mt19937 random(9);
  std::normal_distribution<float> noise(128, 20);
  FitSettings s = settings_of(Directions::kWorld);
  s.hierarchy.block_log2 = 2;  // between larger blocks noise is averaged away
  const auto chosen =
      choose_fit(scene.observe(24, [&](const Vec3&, const Vec3&) { return noise(random); }),
                 scene.positions, s, {true, false, true, false, false});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->settings.hierarchy.strength, 1) << "the strongest candidate";
  EXPECT_EQ(chosen->settings.hierarchy.point_penalty, 5 * HierarchySettings{}.point_penalty);
}

TEST(FitSearch, TheBasisMayBecomeBsplinesOfAboutTheSameSize) {
  const Scene scene;
  // A step in the azimuth of the view, within the first half of the turn.
  const auto step = [](const Vec3& v, const Vec3&) {
    return std::atan2(v[1], v[0]) > 0 ? 220.f : 40.f;
  };
  FitSettings s = settings_of(Directions::kWorld);
  s.basis.order = 1;
  const auto chosen =
      choose_fit(scene.observe(48, step), scene.positions, s, {false, false, false, false, true});
  ASSERT_TRUE(chosen);
  EXPECT_EQ(chosen->settings.basis, (Basis{BasisId::kBspline, 1, 2, 2}));
}

TEST(FitSearch, TheEnvironmentsRadiusIsSettledOrItIsLeftOut) {
  const Scene scene;
  FitSettings s = settings_of(Directions::kReflected);
  s.environment.degree = 6;
  const auto flat = choose_fit(scene.observe(24, [](const Vec3&, const Vec3&) { return 90.f; }),
                               scene.positions, s, FitSearch::none());
  ASSERT_TRUE(flat);
  EXPECT_EQ(flat->settings.environment.degree, 0);
  const Observations seen = scene.observe(24, mirror);
  const auto shiny = choose_fit(seen, scene.positions, s, FitSearch::none());
  EXPECT_EQ(shiny->settings.environment.degree, 6);
  EXPECT_GE(shiny->settings.environment.radius, 2);
  // And the fit is the one that finds the radius itself.
  const auto turned = in_local(seen, s.directions, scene.positions, 0, 1);
  EXPECT_EQ(*fit_view_maps(turned, scene.positions, s),
            *fit_view_maps(turned, scene.positions, shiny->settings));
}

TEST(FitSearch, FewCamerasOrAllFromOneSideKeepTheSettings) {
  const Scene scene;
  Observations seen = scene.observe(7, of_view);
  const auto few = choose_fit(seen, scene.positions, settings_of(Directions::kReflected), kAll);
  ASSERT_TRUE(few);
  EXPECT_EQ(few->outcome, ChosenFit::kTooFewCameras);
  EXPECT_EQ(few->settings.directions, Directions::kReflected);
  // Nine cameras at one place.
  Observations same;
  same.first.push_back(0);
  for (std::size_t p = 0; p < scene.positions.size(); ++p) {
    for (std::uint16_t i = 0; i < 9; ++i) {
      same.direction.push_back({0.5f, 0.25f});
      same.colour.push_back({1, 2, 3});
      same.camera.push_back(i);
    }
    same.first.push_back(same.direction.size());
  }
  EXPECT_EQ(choose_fit(same, scene.positions, settings_of(Directions::kReflected), kAll)->outcome,
            ChosenFit::kTooFewCameras);
}

TEST(FitSearch, DoesNotDependOnTheNumberOfThreads) {
  const Scene scene;
  const Observations seen = scene.observe(16, mirror);
  FitSettings s = settings_of(Directions::kWorld);
  s.environment.degree = 4;
  s.threads = 1;
  const auto one = choose_fit(seen, scene.positions, s, kAll);
  s.threads = 5;
  const auto five = choose_fit(seen, scene.positions, s, kAll);
  ASSERT_TRUE(one && five);
  EXPECT_EQ(one->psnr_chosen, five->psnr_chosen);
  EXPECT_EQ(one->psnr_given, five->psnr_given);
  EXPECT_EQ(one->settings.directions, five->settings.directions);
  EXPECT_EQ(one->settings.basis, five->settings.basis);
  EXPECT_EQ(one->settings.hierarchy.strength, five->settings.hierarchy.strength);
  EXPECT_EQ(one->settings.environment.radius, five->settings.environment.radius);
}

TEST(FitSearch, ThePapersFitHasNothingToSearch) {
  const Scene scene;
  FitSettings s;
  s.basis = {BasisId::kBspline, 2, 1, 1};
  const Observations seen = scene.observe(9, of_view);
  EXPECT_TRUE(choose_fit(seen, scene.positions, s, FitSearch::none()));
  EXPECT_EQ(choose_fit(seen, scene.positions, s, kDirections).error().code, Errc::kInvalidArgument);
}

/// What the encoder refuses before it looks at an image.
TEST(EncoderSettingsCheck, EveryFieldOfTheHierarchicalFitHasItsRange) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto accepted = [](auto edit) {
    EncoderSettings s;
    s.fit = settings_of(Directions::kReflected);
    s.search = kAll;
    edit(s);
    return static_cast<bool>(check_settings(s));
  };
  EXPECT_TRUE(accepted([](EncoderSettings&) {}));
  EXPECT_TRUE(accepted([](EncoderSettings& s) { s.fit.environment.radius = 2; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.environment.radius = 1.9; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.environment.radius = -1; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.environment.degree = 17; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.environment.degree = -1; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.hierarchy.block_log2 = -1; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.hierarchy.block_log2 = 22; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.basis.degree = 11; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) { s.fit.method = FitMethod::kPaper; }));
  EXPECT_FALSE(accepted([](EncoderSettings& s) {
    s.fit.method = FitMethod::kPaper;
    s.fit.basis = {};
  })) << "a search of the paper's fit";
  for (const double bad : {kNan, kInfinity, 0.0, -1.0}) {
    EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.hierarchy.strength = bad; })) << bad;
    EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.hierarchy.growth = bad; })) << bad;
    EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.hierarchy.point_penalty = bad; })) << bad;
    EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.hierarchy.point_growth = bad; })) << bad;
    EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.environment.strength = bad; })) << bad;
  }
  EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.environment.radius = kNan; }));
  EXPECT_FALSE(accepted([&](EncoderSettings& s) { s.fit.environment.radius = kInfinity; }));
}

}  // namespace
}  // namespace slf::fit_search_test
