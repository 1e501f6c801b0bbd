// SPDX-License-Identifier: Apache-2.0
// A capture of a terrace.
#pragma once

#include "tools/synth/synth.h"

namespace slf::synth {

/// @param settings  in range, of the scene "terrace"
/// Memory does not grow with the points, unless they are disturbed.
Result<Done, InputError> synthesise_terrace(const SynthSettings& settings,
                                            const std::filesystem::path& directory,
                                            const Progress& progress);

}  // namespace slf::synth
