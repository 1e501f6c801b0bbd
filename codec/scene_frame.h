// What stands around the parts of a scene in a stream: boxes for the index, filler.
#pragma once

#include <cstdint>
#include <vector>

#include "bitstream/index.h"
#include "codec/coded_unit.h"
#include "codec/scene_layout.h"

namespace slf {

/// Boxes of the slices' cells; none without a base.
std::vector<CellBox> boxes_of(const SceneLayout& layout);

/// Spec 9: zeros before the parts of the scene, where these have more values than bytes allow.
/// Their geometry is enough by itself, or that of the base: what follows may be missing.
/// @param units  that stand before the parts; receives the filler
/// @param cells  of the base
void add_filler(std::vector<CodedUnit>& units, const std::vector<CodedUnit>& parts,
                std::uint64_t cells, std::uint64_t points, std::uint64_t planes);

}  // namespace slf
