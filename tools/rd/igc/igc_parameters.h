// SPDX-License-Identifier: Apache-2.0
// What the decoder has to know: text of KEY=VALUE lines, deflated.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "tools/rd/igc/igc.h"

namespace slf {

struct IgcParameters {
  int width = 0, height = 0;         ///< of every image
  IgcSettings settings;              ///< slf: observe, fit, colour, metadata
  std::vector<std::string> cameras;  ///< names, in coded order
};

/// Length of the text (4 bytes, little endian), then the deflated text.
/// @errors kInvalidArgument: a line end in a name, a metadata pair or the speed.
Result<std::vector<std::uint8_t>, InputError> write_igc_parameters(const IgcParameters& parameters);

/// @param lines  receives what was read as pairs, then the metadata; camera names are left out
/// @errors kInvalidInput: names the line that is missing, misspelt or out of range.
Result<IgcParameters, InputError> read_igc_parameters(std::span<const std::uint8_t> section,
                                                      Metadata& lines);

}  // namespace slf
