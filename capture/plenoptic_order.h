// SPDX-License-Identifier: Apache-2.0
// The order of the points of plenoptic clouds.
#pragma once

#include "slf/plenoptic.h"

namespace slf {

/// Puts points, each of another voxel, and their colours in Morton order. O(P log P).
void sort_by_voxels(PlenopticCloud& cloud);

}  // namespace slf
