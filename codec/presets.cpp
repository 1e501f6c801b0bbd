// Named configurations. Spec annex C.
#include "slf/encoder.h"

namespace slf {

EncoderSettings settings_of(Preset preset) {
  EncoderSettings settings;  // the defaults of the members are the default preset
  if (preset == Preset::kPaper) {
    settings.preset = Preset::kPaper;
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
