// Nodes of the tree as voxels of the kept levels. Spec 8.9.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/sequence_plan.h"

namespace slf {

/// The voxel of a node at `level`: that of its middle, where it is larger than a voxel of the grid.
Voxel node_voxel(std::uint64_t code, int level, const SequencePlan& plan);

/// Those of all nodes, each voxel once.
/// @param codes  ascending
std::vector<Voxel> node_voxels(std::span<const std::uint64_t> codes, int level,
                               const SequencePlan& plan);

}  // namespace slf
