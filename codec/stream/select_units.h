// SPDX-License-Identifier: Apache-2.0
// The units of a stream that are wanted, as they are.
#pragma once

#include <vector>

#include "codec/decoder/request.h"
#include "codec/encoder/coded_unit.h"

namespace slf {

/// Those to keep, in the order of the stream and in its memory.
struct SelectedUnits {
  /// Without those that are written anew (sequence, index, frame, end), and without fillers, which
  /// have no meaning; where not all is kept, without corrections of what the whole decodes to.
  std::vector<UnitView> units;
  bool all = true;  ///< none was left out that has one
};

/// @param chosen  [slices] those to keep
Result<SelectedUnits> select_units(const Units& units, const Request& request,
                                   const std::vector<std::uint8_t>& chosen);

}  // namespace slf
