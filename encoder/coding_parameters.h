// SPDX-License-Identifier: Apache-2.0
// From the encoder's settings to those of the coder.
#pragma once

#include "slf/encoder.h"

namespace slf {

/// @param field  its header; its components too where settings ask for a texture
CodingParameters coding_parameters(const LightField& field, const EncoderSettings& settings);

}  // namespace slf
