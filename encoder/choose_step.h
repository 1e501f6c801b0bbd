// SPDX-License-Identifier: Apache-2.0
// The quantiser step that costs held-out pictures no more than was asked for.
#pragma once

#include "encoder/fit_capture.h"
#include "slf/encoder.h"

namespace slf {

/// Is the step to be chosen, from CaptureFit::held_out? Not where it, or a target, is given, and
/// not where nothing is fitted to pictures.
/// @param cameras  of the fit
bool chooses_step(const EncoderSettings& settings, std::size_t cameras);

/// The step, and where it came from.
struct StepAndOrigin {
  double q;
  ChosenStep chosen;
};

/// The largest step with which the held-out pictures of a fit lose settings.quality_loss at most;
/// where there are none kPlainQ, and why. Nothing is coded: the sample of the fit is quantised as
/// the coder would, some five times.
/// @param settings  their fit is fit.chosen.settings
/// @param points    of the whole that is coded
/// @param cameras   of the fit
/// @errors those of quantise_field
/// The same for any thread count.
Result<StepAndOrigin, InputError> choose_step(const EncoderSettings& settings,
                                              const CaptureFit& fit, const Grid& grid,
                                              std::size_t points, std::size_t cameras);

}  // namespace slf
