// SPDX-License-Identifier: Apache-2.0
// Files of Gaussian splats as input of a verb that reads .slf files.
#pragma once

#include <string>

#include "slf/gaussian_files.h"
#include "tools/stream_input.h"

namespace slf::tools {

/// By content; false of what cannot be read, and of standard input.
bool is_splat_file(const std::string& file);

/// Warns of splats that are left out or mended, unless quiet.
/// @param part  has to be all: splats have no levels, groups or layers
Result<GaussianFile, Failure> read_splat_file(const std::string& verb, const std::string& file,
                                              const PartOptions& part, const LimitOptions& given,
                                              const CommonOptions& common);

}  // namespace slf::tools
