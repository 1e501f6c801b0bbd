// Voxels of a slice from its geometry units. Spec 8.4.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "geometry/occupancy_model.h"
#include "geometry/octree_levels.h"
#include "slf/error.h"

namespace slf {

/// Holds the octree between the geometry units of a slice; they come coarse to fine.
class OctreeDecoder {
 public:
  /// depth: of the slice, 0 .. 21. max_nodes: what no level may exceed (the slice's point count).
  OctreeDecoder(int depth, std::uint64_t max_nodes)
      : depth_(depth), max_nodes_(max_nodes), model_(max_nodes) {}

  /// Decodes the occupancies of levels level() .. end - 1.
  /// @errors kOutOfRange: more nodes than max_nodes; the codeword does not end where the unit does.
  Result<Done> decode(std::span<const std::uint8_t> payload, int end);

  int level() const { return level_; }  ///< of the nodes known so far
  const std::vector<std::uint64_t>& morton() const { return nodes_.morton; }

 private:
  int depth_;
  std::uint64_t max_nodes_;
  int level_ = 0;
  OctreeLevel nodes_ = octree_root();
  OccupancyModel model_;
};

}  // namespace slf
