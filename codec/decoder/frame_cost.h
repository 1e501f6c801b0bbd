// SPDX-License-Identifier: Apache-2.0
// What frames in time take beside the decoding of each. Spec 9.
#pragma once

#include <cstdint>

#include "codec/decoder/decode_cost.h"

namespace slf {

/// Bytes: what is usual, and what nothing exceeds.
struct FrameCost {
  double usual = 0, most = 0;
};

/// What a frame of so many points leaves to the next, and what it has of the one before.
FrameCost frame_cost(const DecodeShape& shape, std::uint64_t points);

/// Bytes of a frame that has so many values a point, and of moving it: at the most.
double cost_of_moving(const FrameState& state, int bits, std::size_t planes);

}  // namespace slf
