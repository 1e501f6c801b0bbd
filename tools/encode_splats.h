// SPDX-License-Identifier: Apache-2.0
// slf encode of Gaussian splats.
#pragma once

#include <string>

#include "slf/gaussian_files.h"
#include "tools/encode_options.h"

namespace slf::tools {

/// From a file of splats to an .slf with their shapes and opacities.
/// @errors kUsage: options that are for photographs; those of reading and encode_gaussians
Outcome encode_splats(const EncodeOptions& given, EncoderSettings settings);

/// The splats of a file that are wanted: in --crop, with --up, and warnings of the others.
Result<GaussianFile, Failure> wanted_splats(const EncodeOptions& given, const std::string& file);

}  // namespace slf::tools
