// SPDX-License-Identifier: Apache-2.0
// Voxels from geometry units: of the base, or of a slice. Spec 8.4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "entropy/range_decoder.h"
#include "geometry/occupancy_model.h"
#include "geometry/octree_levels.h"
#include "slf/error.h"

namespace slf {

/// Holds the octree between geometry units; they come coarse to fine.
class OctreeDecoder {
 public:
  /// From the root: the base, or a slice where there is no base.
  /// @param depth      levels that are coded, 0 .. 21
  /// @param max_nodes  what no level may exceed: the number of cells, or of points
  OctreeDecoder(int depth, std::uint64_t max_nodes, OccupancyStates states);
  /// A slice, from its cells on.
  /// @param level  of the cells; depth and levels are those of the grid
  /// @param cells  their codes at that level, ascending; at least one
  OctreeDecoder(int depth, std::uint64_t max_nodes, OccupancyStates states, int level,
                std::span<const std::uint64_t> cells);

  /// Decodes the occupancies of levels level() .. end - 1.
  /// @errors kOutOfRange: more nodes than max_nodes; the codeword does not end where the unit does.
  Result<Done> decode(std::span<const std::uint8_t> payload, int end);
  /// The same of the last levels of a base whose cells have classes (8.4.5): [cells].
  /// @errors kOutOfRange also: the cells weigh more than 2^24 together.
  Result<std::vector<std::uint8_t>> decode_with_classes(std::span<const std::uint8_t> payload,
                                                        int end);

  int level() const { return level_; }  ///< of the nodes known so far
  const std::vector<std::uint64_t>& morton() const { return nodes_.morton; }

  /// Before the first unit of a frame that is predicted. reference: kept by pointer
  void predict_from(const MovedReference& reference) { model_.predict_from(reference); }
  const OccupancyStates& states() const { return model_.states(); }  ///< after the last unit
  /// The same and the nodes, out of a decoder that is done: memory that was never touched is dear.
  OccupancyStates take_states() { return model_.take_states(); }
  std::vector<std::uint64_t> take_morton() { return std::move(nodes_.morton); }
  void start_from(const OccupancyStates& states) { model_.start_from(states); }

 private:
  Result<Done> decode_levels(RangeDecoder& given, int end, bool all_neighbours);

  int depth_;
  std::uint64_t max_nodes_;
  int level_;
  OctreeLevel nodes_;
  OccupancyModel model_;
};

}  // namespace slf
