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
};

constexpr std::array<Effort, 9> kEfforts = {{
    {2, 0, 0, 0, 0, false, false},
    {4, 0, 1, 4, 0, false, false},
    {6, 0, 1, 6, 0, false, false},
    {8, 0, 2, 4, 0, false, true},
    {8, 16, 2, 6, 0, false, true},
    {10, 16, 2, 6, 0, false, true},
    {10, 16, 2, 6, 12000, false, true},
    {10, 16, 2, 8, 12000, true, true},
    {10, 16, 2, 8, 24000, true, true},
}};

void set_effort(int effort, EncoderSettings& settings) {
  const Effort& e = kEfforts[static_cast<std::size_t>(std::clamp(effort, 1, 9) - 1)];
  settings.fit.basis.degree = e.degree;
  settings.fit.environment.degree = e.environment_degree;
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
  }
  return settings;
}

}  // namespace slf
