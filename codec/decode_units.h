// The decoder behind the splitting of a stream into units.
#pragma once

#include "codec/scene_units.h"
#include "slf/decoder.h"

namespace slf {

/// Units to the light field. Spec 8.
/// @param opened  its header may say that more is left out than the sequence unit does
Result<LightField> decode_units(const OpenStream& opened, const DecodeOptions& options);

}  // namespace slf
