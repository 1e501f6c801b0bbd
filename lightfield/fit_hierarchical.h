// The hierarchical fit.
#pragma once

#include <span>
#include <vector>

#include "slf/fit.h"

namespace slf {

/// [P][K][3]; points without observations have what their block has, and no mean.
/// @param observations  of the frame's directions
std::vector<float> fit_hierarchical(const Observations& observations,
                                    std::span<const Voxel> positions, const FitSettings& settings,
                                    const Progress& progress);

}  // namespace slf
