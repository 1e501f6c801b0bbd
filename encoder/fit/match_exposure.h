// SPDX-License-Identifier: Apache-2.0
// The gains that make photographs agree in exposure and white balance.
#pragma once

#include <span>
#include <vector>

#include "encoder/fit/exposure_pairs.h"
#include "slf/exposure.h"
#include "slf/fit.h"

namespace slf {

/// Gains that explain the pairs: weighted least squares with a weak pull to 1, pairs that disagree
/// with the others left out by degrees.
/// @param cameras  of the capture
ExposureReport exposure_gains(const std::vector<ExposurePair>& pairs, std::size_t cameras);

/// Whether most photographs differ, and gains explain how: what kAuto asks.
bool gains_pay(const ExposureReport& report);

/// Looks at a sample of the capture's points in every photograph. The report has no gains where
/// they are not to be applied, there are no points, or nothing could be compared.
/// @errors those of observe, but for points that nobody sees
/// The same for any thread count.
Result<ExposureReport, InputError> match_exposure(const Capture& capture,
                                                  std::span<const int> cameras, MatchExposure mode,
                                                  int threads);

}  // namespace slf
