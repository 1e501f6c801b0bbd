// Mirror of geometry/octree_decoder.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// One payload per entry of level_ends (ascending, the last is `depth`): the occupancies of the
/// levels from the previous end (0 at first) up to this one.
/// @param morton  distinct codes below 8^depth, ascending; at least one
std::vector<std::vector<std::uint8_t>> encode_octree(std::span<const std::uint64_t> morton,
                                                     int depth, std::span<const int> level_ends);

}  // namespace slf
