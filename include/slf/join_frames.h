// SPDX-License-Identifier: Apache-2.0
// Parts of a moving light field to one stream, without coding frames again. Spec 7.13.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"
#include "slf/scene.h"

namespace slf {

/// Does a stream hold frames in time?
bool is_of_frames(std::span<const std::uint8_t> stream);

enum class JoinOrder : std::uint8_t {
  kByNumber,  ///< numbers of frames go on from part to part, in any order of the parts
  kAsGiven,   ///< one after the other: frames get new numbers and times
};

/// Joins streams of frames. With kByNumber the parts of one sequence
/// (FrameSettings::part) become the bytes that one process writes. With kAsGiven numbers and times
/// go on from those of the first part; a part begins as long after the last frame before it as that
/// one did after its own.
/// @param parts  1 or more, whole: units are not opened but for headers
/// @errors kInvalidInput, names the part: no stream of frames, cut short, another grid, other
///         functions, attributes or steps than the first, units that were left out; kByNumber: a
///         frame that is missing, from 0 on, or there twice (frames that are missing at the end
///         nobody knows of), a time that does not ascend. kInvalidArgument: no
///         parts. kLimitExceeded: max_memory. O(bytes)
/// @param limits  max_memory: of the lists of frames of all parts
Result<std::vector<std::uint8_t>, InputError> join_frames(
    std::span<const PartStream> parts, JoinOrder order = JoinOrder::kByNumber,
    const DecodeLimits& limits = DecodeLimits::none());

}  // namespace slf
