// The decoder behind the splitting of a stream into units.
#pragma once

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "slf/decoder.h"

namespace slf {

/// Units to the light field. Spec 8.
/// @param set  of their sequence unit; it may say that more is left out than that unit does
Result<LightField> decode_units(const Units& units, const SequenceParameterSet& set,
                                const DecodeOptions& options);

}  // namespace slf
