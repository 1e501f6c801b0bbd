// SPDX-License-Identifier: Apache-2.0
// What is wrong with an encoder's settings before anything is read.
#pragma once

#include "slf/encoder.h"
#include "slf/error.h"

namespace slf {

/// @errors kInvalidArgument, with the setting's name: outside of its range (encoder/setting_rows.h);
///         a fit or a search that does not go with the others
Result<Done, InputError> check_settings(const EncoderSettings& settings);

}  // namespace slf
