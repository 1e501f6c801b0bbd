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
  std::size_t search_points;  ///< 0: no cross-validation
  bool search_basis;
  bool refine;  ///< geometry, where photographs disagree
  /// DensifySettings::from. (Q = 48 and 64, effort 5, a can of 20,000 points, 2.3 pixels: 29,160 B
  /// 23.86 dB without, 35,927 B 28.08 with. blender_can, 1.85: 37,304 B 26.53 and 33,506 B 26.99,
  /// for 2.4 times the points and 1.7 times the seconds.)
  double densify_from;
};

constexpr std::array<Effort, 9> kEfforts = {{
    {2, 0, 0, 0, 0, false, false, 2},
    {4, 0, 1, 4, 0, false, false, 2},
    {6, 0, 1, 6, 0, false, false, 2},
    {8, 0, 2, 4, 0, false, true, 2},
    {8, 16, 2, 6, 0, false, true, 2},
    {10, 16, 2, 6, 0, false, true, 2},
    {10, 16, 2, 6, 12000, false, true, 2},
    {10, 16, 2, 8, 12000, true, true, 1.25},
    {10, 16, 2, 8, 24000, true, true, 1.25},
}};

void set_effort(int effort, EncoderSettings& settings) {
  const Effort& e = kEfforts[static_cast<std::size_t>(std::clamp(effort, 1, 9) - 1)];
  settings.fit.basis.degree = e.degree;
  settings.fit.environment.degree = e.environment_degree;
  settings.densify.from = e.densify_from;
  settings.refine_geometry = e.refine ? RefineGeometry::kAuto : RefineGeometry::kOff;
  settings.fit.pictures.rounds = e.picture_rounds;
  settings.fit.pictures.steps = std::max(e.picture_steps, 1);
  if (e.search_points == 0) {
    settings.search = FitSearch::none();
  } else {
    settings.search.points = e.search_points;
    settings.search.basis = e.search_basis;
  }
}

}  // namespace

EncoderSettings settings_of(Preset preset, int effort) {
  EncoderSettings settings;  // the defaults of the members are the default preset
  set_effort(effort, settings);
  if (preset == Preset::kPaper) {
    settings.preset = Preset::kPaper;
    settings.refine_geometry = RefineGeometry::kOff;
    settings.densify.mode = Densify::kOff;
    settings.check_cameras = false;
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
