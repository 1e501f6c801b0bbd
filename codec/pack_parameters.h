// Checked parameters of the coder, as the sequence unit has them. Spec 7.2.
#pragma once

#include "attributes/coefficient_decoder.h"
#include "bitstream/parameter_sets.h"
#include "slf/encoder.h"

namespace slf {

/// @errors kInvalidArgument: names the parameter.
Result<SequenceParameterSet, InputError> sequence_of(const LightField& field,
                                                     const CodingParameters& parameters);

std::vector<std::uint32_t> plane_steps(const SequenceParameterSet& set);  ///< [3 K]

}  // namespace slf
