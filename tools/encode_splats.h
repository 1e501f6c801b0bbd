// SPDX-License-Identifier: Apache-2.0
// slf encode of Gaussian splats.
#pragma once

#include "tools/encode_options.h"

namespace slf::tools {

/// From a file of splats to an .slf with their shapes and opacities.
/// @errors kUsage: options that are for photographs; those of reading and encode_gaussians
Outcome encode_splats(const EncodeOptions& given, EncoderSettings settings);

}  // namespace slf::tools
