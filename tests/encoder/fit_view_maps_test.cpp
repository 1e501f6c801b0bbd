// SPDX-License-Identifier: Apache-2.0
// What holds of a fit to points whatever its equations: settings, threads, progress.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <thread>

#include "random_sightings.h"
#include "slf/fit.h"

namespace slf::fit_view_maps_test {
namespace {

TEST(FitViewMaps, AConstantColourIsKeptExactlyWhereTheDcIsFreeAndShrunkWhereItIsNot) {
  const RandomSightings scene = random_sightings({40, 3});
  FitSettings settings;
  settings.penalise_dc = false;
  const auto free = fit_view_maps(scene.seen, scene.positions, settings);
  settings.penalise_dc = true;
  const auto paper = fit_view_maps(scene.seen, scene.positions, settings);
  ASSERT_TRUE(free && paper);
  // The third channel of the scene is 200 everywhere.
  EXPECT_NEAR((*free)[2], 200, 1e-3);
  EXPECT_NEAR((*free)[3 * 128 + 2], 200, 1e-3);
  for (std::size_t k = 1; k < 128; ++k) EXPECT_NEAR((*free)[3 * k + 2], 0, 1e-3);
  EXPECT_LT((*paper)[3 * 128 + 2], 190);
}

TEST(FitViewMaps, DoesNotDependOnTheNumberOfThreads) {
  std::vector<int> counts(700, 0);
  for (std::size_t p = 0; p < counts.size(); ++p) counts[p] = static_cast<int>(p * 7 % 23);
  const RandomSightings scene = random_sightings(counts);
  FitSettings settings = paper_fit({BasisId::kBspline, 2, 2, 2}, 1);
  const auto one = fit_view_maps(scene.seen, scene.positions, settings);
  ASSERT_TRUE(one);
  for (const int threads : {2, 7}) {
    settings.threads = threads;
    const auto many = fit_view_maps(scene.seen, scene.positions, settings);
    ASSERT_TRUE(many);
    EXPECT_EQ(*one, *many) << threads << " threads";
  }
}

TEST(FitViewMaps, ReportsProgressOnTheCallingThreadUpToOne) {
  const RandomSightings scene = random_sightings(std::vector<int>(600, 3));
  const auto caller = std::this_thread::get_id();
  double last = 0;
  const auto fitted =
      fit_view_maps(scene.seen, scene.positions, {}, [&](const char* stage, double f) {
        EXPECT_STREQ(stage, "fit");
        EXPECT_EQ(std::this_thread::get_id(), caller);
        EXPECT_GE(f, last);
        EXPECT_LE(f, 1);
        last = f;
      });
  ASSERT_TRUE(fitted);
  EXPECT_GT(last, 0.5);
}

TEST(FitViewMaps, RefusesSettingsAndObservationsThatCannotBe) {
  const RandomSightings scene = random_sightings({3, 0});
  const auto code = [&](const FitSettings& settings) {
    const auto fitted = fit_view_maps(scene.seen, scene.positions, settings);
    return fitted ? Errc::kNotSlf : fitted.error().code;
  };
  FitSettings good;
  for (const auto& change : std::vector<std::function<void(FitSettings&)>>{
           [](FitSettings& s) { s.lambda = -1; }, [](FitSettings& s) { s.lambda = NAN; },
           [](FitSettings& s) { s.beta = INFINITY; }, [](FitSettings& s) { s.iterations = -1; },
           [](FitSettings& s) { s.neighbours = 0; }, [](FitSettings& s) { s.neighbours = 65; },
           [](FitSettings& s) { s.basis.order = 5; },
           [](FitSettings& s) { s.basis.scales_theta = 7; }}) {
    FitSettings bad = good;
    change(bad);
    EXPECT_EQ(code(bad), Errc::kInvalidArgument);
  }
  RandomSightings wrong = scene;
  wrong.positions.pop_back();
  EXPECT_EQ(fit_view_maps(wrong.seen, wrong.positions, good).error().code, Errc::kInvalidArgument);
  const RandomSightings dark = random_sightings({0, 0});
  EXPECT_EQ(fit_view_maps(dark.seen, dark.positions, good).error().code, Errc::kInvalidInput);
}

}  // namespace
}  // namespace slf::fit_view_maps_test
