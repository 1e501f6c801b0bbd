// SPDX-License-Identifier: Apache-2.0
// Whether photographs and masks fit the calibration and the cloud. docs/captures.md lists what is
// refused and what is warned about.
#pragma once

#include <string>

#include "slf/capture.h"

namespace slf {

/// Opens every image and mask, reads its header and compares its size with the calibration.
/// Warnings go to the capture.
Result<Done, InputError> check_photographs(Capture& capture);

/// Whether masks and alpha leave anything of the cloud: a few photographs are looked at.
/// @errors those of load_image
Result<Done, InputError> check_masks(Capture& capture);

}  // namespace slf
