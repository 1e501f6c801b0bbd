// SPDX-License-Identifier: Apache-2.0
// Views as observations of view maps.
#pragma once

#include "encoder/fit_capture.h"
#include "encoder/plenoptic/plenoptic_metadata.h"
#include "slf/plenoptic.h"

namespace slf {

/// Fits view maps to what the views see that are not held out, as if they were cameras.
/// @param cloud  its points are given up: what is held is little more than the field
/// @param settings  receives the fit that was chosen
/// @param shift  of the functions; empty: as fine as they can be
/// @errors kInvalidInput: fewer than two directions; those of choose_fit and fit_view_maps
Result<LightField, InputError> fit_plenoptic(PlenopticCloud& cloud, const PlenopticRecord& record,
                                             EncoderSettings& settings, ChosenFit& chosen,
                                             const Progress& progress,
                                             const std::vector<int>& shift = {});

/// What the views see of the view maps, and the mean of them as the own colour.
void look_from_views(const LightField& field, const PlenopticRecord& record, int threads,
                     PlenopticCloud& cloud);

}  // namespace slf
