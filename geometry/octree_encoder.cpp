#include "geometry/octree_encoder.h"

#include "bitstream/multiversion.h"
#include "entropy/range_encoder.h"
#include "geometry/occupancy_model.h"
#include "geometry/octree_levels.h"

namespace slf {
namespace {

/// Occupancy of every node of a level, whose cells have 3 * below bits left below them.
std::vector<std::uint8_t> occupancies(std::span<const std::uint64_t> morton, std::size_t nodes,
                                      int below) {
  std::vector<std::uint8_t> occupancy(nodes);
  std::size_t n = 0;
  for (std::size_t i = 0; i < morton.size(); ++i) {
    if (i > 0 && morton[i] >> (3 * below) != morton[i - 1] >> (3 * below)) ++n;
    occupancy[n] =
        static_cast<std::uint8_t>(occupancy[n] | 1u << (morton[i] >> (3 * (below - 1)) & 7));
  }
  return occupancy;
}

}  // namespace

SLF_MULTIVERSION_ALL
std::vector<std::vector<std::uint8_t>> encode_octree(std::span<const std::uint64_t> morton,
                                                     int depth, std::span<const int> level_ends) {
  std::vector<std::vector<std::uint8_t>> payloads;
  OccupancyModel model(morton.size());
  OctreeLevel nodes = octree_root();
  int level = 0;
  for (const int end : level_ends) {
    RangeEncoder encoder;
    for (; level < end; ++level) {
      model.start_level(level);
      const auto occupancy = occupancies(morton, nodes.size(), depth - level);
      for (std::size_t n = 0; n < nodes.size(); ++n)
        nodes.occupancy[n] = model.code(encoder, nodes, n, occupancy[n]);
      nodes = octree_children(nodes, level + 1 < depth);
    }
    payloads.push_back(encoder.finish());
  }
  return payloads;
}

}  // namespace slf
