// SPDX-License-Identifier: Apache-2.0
// Which options of slf encode act on frames in time.
#pragma once

#include <string>
#include <vector>

#include "slf/frame_inputs.h"
#include "tools/encode_options.h"

namespace slf::tools {

/// An option of the command line by its long name, without dashes.
struct GivenOption {
  std::string name;
  std::string value;  ///< the first; none of a flag
};

/// "captures", "clouds", "splats" or "clouds of views".
std::string words_of(FrameKind kind);

/// What was given on the command line, but for positionals.
std::vector<GivenOption> given_options(const CLI::App& verb);

/// Refuses what frames do not have, and names what would do. A table and the settings' rows say
/// what they have: an option that is in neither is refused, so that none is without effect because
/// nobody thought of it.
/// @errors kUsage
Outcome check_frame_options(const std::vector<GivenOption>& given, const EncodeOptions& encode,
                            FrameKind kind);

}  // namespace slf::tools
