// SPDX-License-Identifier: Apache-2.0
// Checked parameters of the coder, as the sequence unit has them. Spec 7.2.
#pragma once

#include "attributes/coefficient_models.h"
#include "bitstream/parameter_sets.h"
#include "codec/encoder/scene_layout.h"
#include "slf/encoder.h"

namespace slf {

/// @errors kInvalidArgument: names the parameter.
Result<SequenceParameterSet, InputError> sequence_of(const LightField& field,
                                                     const CodingParameters& parameters);

/// The same of a frame, which may have no points.
Result<SequenceParameterSet, InputError> sequence_of_frame(const LightField& field,
                                                           const CodingParameters& parameters);

/// The same of a field that was checked, whose components may have moved on.
Result<SequenceParameterSet, InputError> sequence_of_checked(const LightField& field,
                                                             const CodingParameters& parameters);

/// The base, which ends a level range of either kind.
void set_base(const SceneLayout& layout, SequenceParameterSet& set);

std::vector<std::uint32_t> plane_steps(const SequenceParameterSet& set);  ///< [3 K]

}  // namespace slf
