// SPDX-License-Identifier: Apache-2.0
// Pictures of a light field against photographs. Spec annex D.
#pragma once

#include <span>

#include "encoder/measure/captured_view.h"
#include "slf/evaluate.h"

namespace slf {

/// What of a Quality is of pictures: draws every camera and compares, one camera per thread.
/// @errors those of load_image and settings.error_map
Result<Done, InputError> evaluate_images(const DrawPicture& draw, const Capture& capture,
                                         std::span<const int> cameras,
                                         const CapturedSurface& surface,
                                         const EvaluateSettings& settings, const Progress& progress,
                                         Quality& quality);

}  // namespace slf
