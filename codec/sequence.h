// SPDX-License-Identifier: Apache-2.0
// Between the coded sequence parameters and the header people see. Spec 7.2.
#pragma once

#include "attributes/coefficient_models.h"
#include "bitstream/parameter_sets.h"
#include "slf/types.h"

namespace slf {

LightFieldHeader header_of(const SequenceParameterSet& set);

/// group and steps of every function, from the runs of the plane table.
std::vector<int> function_groups(const SequenceParameterSet& set);
PlaneGroups plane_groups(const SequenceParameterSet& set);
std::vector<std::array<std::uint32_t, 3>> function_steps(const SequenceParameterSet& set);

/// To the coarser voxels that `levels` of the grid's levels give: their centres. Spec 8.9.
void make_coarser(LightFieldHeader& header, int levels);

}  // namespace slf
