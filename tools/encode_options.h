// SPDX-License-Identifier: Apache-2.0
// What slf encode and slf igc are told: an input, an output, and settings in place of a preset's.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "slf/frame_inputs.h"
#include "slf/settings.h"
#include "tools/failure.h"
#include "tools/options.h"

namespace slf::tools {

struct EncodeOptions {
  const char* verb = "encode";  ///< for messages
  std::string capture, output, points, images, split, crs;
  std::optional<FrameInput> frame;   ///< that the capture is of
  std::vector<double> crop;          ///< two corners in world units, or nothing
  std::optional<WorldChange> world;  ///< --points-world
  bool up_given = false;
  UpAxis up = UpAxis::kPlusZ;
  GivenSettings given;
  std::vector<std::string> metadata;  ///< key=value
  std::string notes;
  CommonOptions common;
};

void add_encode_options(CLI::App& verb, EncodeOptions& options);

/// Those of them that lead to view maps: input, preset, geometry, observation, fit, and -j,
/// --quiet,
/// --json.
void add_igc_options(CLI::App& verb, EncodeOptions& options);

/// The preset's settings with everything that was given in its place.
Result<EncoderSettings, Failure> resolved(const EncodeOptions& given);

}  // namespace slf::tools
