// SPDX-License-Identifier: Apache-2.0
// choose_fit of slf/fit.h, of observations wherever they lie.
#pragma once

#include <span>

#include "encoder/fit/environment_fit.h"
#include "encoder/fit/pointwise_observations.h"
#include "slf/fit.h"

namespace slf {

/// @param observations  of world directions, of as many points; one at least
/// @param points        mirror_points of them; not read where there is nothing to choose
/// @errors those of check_fit_settings; kInvalidArgument: a search with kPaper
Result<ChosenFit, InputError> choose_fit(const PointwiseObservations& observations,
                                         std::span<const Voxel> positions,
                                         const MirrorPoints& points, const FitSettings& settings,
                                         const FitSearch& search, const Progress& progress = {});

/// Whether choose_fit has something to choose.
bool chooses_fit(const FitSettings& settings, const FitSearch& search);

}  // namespace slf
