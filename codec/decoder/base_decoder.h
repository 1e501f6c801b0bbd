// SPDX-License-Identifier: Apache-2.0
// The base of a scene: its cells and their components, from which all slices go on. Spec 8.2.
#pragma once

#include <vector>

#include "bitstream/index.h"
#include "codec/decoder/decoder_state.h"

namespace slf {

/// 8.4: the cells and what they weigh.
/// @errors kOutOfRange also where they are not as many as the slices say.
Result<BaseState> decode_base_geometry(const PartUnits& units, const Request& request);

/// 7.7: where an index has boxes, and the base is known, they are those of the slices.
Result<Done> check_boxes(const Units& units, const StreamHeader& stream, const BaseState& base);

/// [slices] Those that are opened, by the cells of the region. Spec 8.9.4.
std::vector<std::uint8_t> choose_slices_by_cell(const Request& request, const BaseState& base);

/// 8.6 - 8.8, for the slices to go on from, on one thread: their geometry, which needs all else of
/// the base, may be decoded beside it.
Result<BaseValues> decode_base_components(const PartUnits& units, const Request& request,
                                          const BaseState& base);

/// What the base gives out by itself: all that was asked for, or all that there is. Spec 8.9.
Result<Done> give_out_base(const PartUnits& units, const Request& request, int threads,
                           const BaseState& base, LightField& field);

}  // namespace slf
