// SPDX-License-Identifier: Apache-2.0
// Mirror of geometry/octree_decoder.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/occupancy_model.h"
#include "geometry/octree_levels.h"

namespace slf {

/// Holds the octree between geometry units; they come coarse to fine.
class OctreeEncoder {
 public:
  /// @param morton  distinct codes below 8^depth, ascending; at least one. Kept by reference.
  /// @param level   where coding starts: that of the cells of a slice, 0 for a whole tree
  OctreeEncoder(std::span<const std::uint64_t> morton, int depth, OccupancyStates states,
                int level = 0);

  /// The occupancies of the levels from the last end up to this one.
  /// @param classes  of the cells at `end`, where they are those of a base: 8.4.5; empty: none
  std::vector<std::uint8_t> encode(int end, std::span<const std::uint8_t> classes = {});

  /// Before the first unit of a frame that is predicted. reference: kept by pointer
  void predict_from(const MovedReference& reference) { model_.predict_from(reference); }
  const OccupancyStates& states() const { return model_.states(); }  ///< after the last unit
  void start_from(const OccupancyStates& states) { model_.start_from(states); }

 private:
  std::span<const std::uint64_t> morton_;
  int depth_, level_;
  OctreeLevel nodes_;
  OccupancyModel model_;
};

/// A whole tree, one payload per entry of level_ends (ascending, the last is `depth`).
std::vector<std::vector<std::uint8_t>> encode_octree(std::span<const std::uint64_t> morton,
                                                     int depth, std::span<const int> level_ends);

}  // namespace slf
