// SPDX-License-Identifier: Apache-2.0
// What tells one training from another.
#pragma once

#include <span>

#include "encoder/train/train_surfels.h"
#include "encoder/train/training_checkpoint.h"

namespace slf {

/// Bytes of a training that decide what comes out of it: settings, photographs, first surfels.
TrainingDigest digest_of_training(std::span<const TrainingView> views,
                                  const TrainSettings& settings, const TrainedSurfels& surfels);

}  // namespace slf
