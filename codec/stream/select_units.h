// SPDX-License-Identifier: Apache-2.0
// The units of a stream that are wanted, as they are.
#pragma once

#include <vector>

#include "codec/decoder/request.h"
#include "codec/encoder/coded_unit.h"

namespace slf {

/// In the order of the stream, without those that are written anew: sequence, index, frame, end.
/// @param chosen  [slices] those to keep
Result<std::vector<CodedUnit>> select_units(const Units& units, const Request& request,
                                            const std::vector<std::uint8_t>& chosen);

}  // namespace slf
