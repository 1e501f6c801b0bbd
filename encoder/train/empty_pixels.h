// SPDX-License-Identifier: Apache-2.0
// Where photographs show no object: there splats are to hide nothing. Otherwise they may paint the
// background's colour in front of it, which photographs cannot tell, and anybody who looks at the
// object before another background can.
#pragma once

#include <span>

#include "encoder/train/training_view.h"

namespace slf {

/// Sets TrainingView::hiding where the view's photograph has an outline, a certain one: what is
/// about as grey as the background may be the object.
/// @errors those of load_image. The same for any number of threads. O(pixels)
Result<Done, InputError> charge_for_hiding(const Capture& capture, int threads,
                                           std::span<TrainingView> views);

}  // namespace slf
