// SPDX-License-Identifier: Apache-2.0
// The metadata of a stream of which the beginning was read: most files have them at their end.
#pragma once

#include <cstdint>
#include <span>

#include "slf/part_decoder.h"

namespace slf {

/// @param head  the first StreamHead::bytes of a stream, without damage
/// @return those of the stream's first frame where the index says they lie; none: there are none
/// @errors kUnreadable; those of a damaged unit; kOutOfRange index_unit_bytes: another unit is
/// there
Result<Metadata> read_metadata_behind(const StreamSource& source,
                                      std::span<const std::uint8_t> head,
                                      const DecodeLimits& limits);

}  // namespace slf
