// SPDX-License-Identifier: Apache-2.0
// Nodes of the tree as voxels of the kept levels. Spec 8.9.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/decoder/request.h"

namespace slf {

/// The voxels of nodes at `level`, each once: those of their middles, where nodes are larger than
/// voxels of the grid.
/// @param codes  ascending
std::vector<Voxel> node_voxels(std::span<const std::uint64_t> codes, int level,
                               const Request& request);

}  // namespace slf
