// SPDX-License-Identifier: Apache-2.0
// Where a person looks first, where photographs show more than one object.
#pragma once

#include <span>

#include "encoder/train/training_cache.h"
#include "slf/capture.h"

namespace slf {

/// Adds the view of the camera in the middle of the others (`view`, spec/registry.md), unless
/// outlines show one object, or the metadata of a file name a view.
/// @param named    of the file
/// @param cameras  at least one
/// @param cache    after a training by them
void add_middle_view(const Capture& capture, std::span<const int> cameras,
                     const TrainingCache& cache, const Metadata& named, Metadata& metadata);

}  // namespace slf
