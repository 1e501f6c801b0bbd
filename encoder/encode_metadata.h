// SPDX-License-Identifier: Apache-2.0
// What the encoder records of itself in the metadata unit.
#pragma once

#include "slf/encoder.h"

namespace slf {

/// The resolved settings, then settings.metadata. No time, no path, no machine.
Metadata encoder_metadata(const EncoderSettings& settings, const Encoded& encoded,
                          std::size_t cameras);

/// Indices of the cameras with a verdict, in their order: "3 17".
std::string cameras_with(CameraVerdict verdict, const std::vector<CameraTrust>& cameras);

/// What of it is of the fit.
Metadata fit_metadata(const ChosenFit& chosen);

/// What is recorded of the grid: whether it was given, and its voxels in pixels.
Metadata grid_metadata(const EncoderSettings& settings, const Grid& grid, const Density& density);

}  // namespace slf
