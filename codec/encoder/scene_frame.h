// SPDX-License-Identifier: Apache-2.0
// What stands around the parts of a scene in a stream: boxes for the index.
#pragma once

#include <vector>

#include "bitstream/index.h"
#include "codec/encoder/scene_layout.h"

namespace slf {

/// Boxes of the slices' cells; none without a base.
std::vector<CellBox> boxes_of(const SceneLayout& layout);

}  // namespace slf
