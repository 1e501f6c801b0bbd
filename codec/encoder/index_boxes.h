// SPDX-License-Identifier: Apache-2.0
// Boxes of slices, for the index. Spec 7.7.
#pragma once

#include <vector>

#include "bitstream/index.h"
#include "codec/encoder/scene_layout.h"

namespace slf {

/// Boxes of the slices' cells; none without a base.
std::vector<CellBox> boxes_of(const SceneLayout& layout);

}  // namespace slf
