// SPDX-License-Identifier: Apache-2.0
// Where a person looks first, where photographs show more than one object.
#pragma once

#include <span>
#include <string>

#include "encoder/train/training_cache.h"
#include "slf/capture.h"

namespace slf {

/// The view of the camera in the middle of the others, as metadata has it (`view`,
/// spec/registry.md).
/// @param cameras  at least one
/// @param cache  after a training by them
std::string middle_view(const Capture& capture, std::span<const int> cameras,
                        const TrainingCache& cache);

}  // namespace slf
