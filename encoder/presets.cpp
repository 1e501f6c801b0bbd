// SPDX-License-Identifier: Apache-2.0
// Named configurations. Spec annex C.
#include <algorithm>
#include <array>

#include "slf/encoder.h"

namespace slf {
namespace {

/// What an effort has; each has at least what the one before has.
struct Effort {
  int degree, environment_degree;
  int picture_rounds, picture_steps;
  std::size_t direction_points;  ///< cross-validation of the directions alone, on so many; 0: none
  std::size_t search_points;     ///< of all that FitSearch has but the basis; 0: none
  bool surface;                  ///< mended or trained, where photographs disagree
  /// DensifySettings::from. (Q = 48 and 64, effort 5, a can of 20,000 points, 2.3 pixels: 29,160 B
  /// 23.86 dB without, 35,927 B 28.08 with. blender_can, 1.85: 37,304 B 26.53 and 33,506 B 26.99,
  /// for 2.4 times the points and 1.7 times the seconds.)
  double densify_from;
};

constexpr std::array<Effort, kMostEffort> kEfforts = {{
    {2, 0, 0, 0, 0, 0, false, 2},
    {4, 0, 1, 4, 0, 0, false, 2},
    {6, 0, 1, 6, 0, 0, false, 2},
    {8, 0, 2, 4, 4000, 0, true, 2},
    {8, 16, 2, 6, 4000, 0, true, 2},
    {10, 16, 2, 6, 4000, 0, true, 2},
    {10, 16, 2, 6, 0, 12000, true, 2},
    {10, 16, 2, 6, 0, 12000, true, 1.25},
}};

void set_effort(int effort, EncoderSettings& settings) {
  const Effort& e = kEfforts[static_cast<std::size_t>(std::clamp(effort, 1, kMostEffort) - 1)];
  settings.fit.basis.degree = e.degree;
  settings.fit.environment.degree = e.environment_degree;
  settings.densify.from = e.densify_from;
  settings.surface = e.surface ? Surface::kAuto : Surface::kGiven;
  settings.fit.pictures.rounds = e.picture_rounds;
  settings.fit.pictures.steps = std::max(e.picture_steps, 1);
  if (e.search_points > 0) {
    settings.search.points = e.search_points;
  } else {
    settings.search = FitSearch::none();
    settings.search.directions = e.direction_points > 0;
    if (e.direction_points > 0) settings.search.points = e.direction_points;
  }
}

}  // namespace

EncoderSettings settings_of(Preset preset, int effort) {
  EncoderSettings settings;  // the defaults of the members are the default preset
  set_effort(effort, settings);
  if (preset == Preset::kPaper) {
    settings.preset = Preset::kPaper;
    settings.q = kPlainQ;
    settings.surface = Surface::kGiven;
    settings.densify.mode = Densify::kOff;
    settings.match_exposure = MatchExposure::kOff;
    settings.check_cameras = false;
    settings.photograph_pixels = 0;
    settings.grid_bits = 9;
    settings.fit = {};
    settings.search = FitSearch::none();
    settings.fit.penalise_dc = true;
    settings.transform = TransformMode::kNone;
    settings.steps_by_norm = false;
    settings.colour = ColourTransform::kNone;
    settings.coefficients = CoefficientCoder::kIndependent;
    settings.predict = false;
    settings.rdo = 0;
    settings.base_levels = 0;
  }
  return settings;
}

}  // namespace slf
