#include "geometry/octree_decoder.h"

#include <bit>

#include "bitstream/multiversion.h"
#include "entropy/range_decoder.h"

namespace slf {

OctreeDecoder::OctreeDecoder(int depth, std::uint64_t max_nodes, OccupancyStates states)
    : depth_(depth),
      max_nodes_(max_nodes),
      level_(0),
      nodes_(octree_root()),
      model_(std::move(states)) {}

OctreeDecoder::OctreeDecoder(int depth, std::uint64_t max_nodes, OccupancyStates states, int level,
                             std::span<const std::uint64_t> cells)
    : depth_(depth),
      max_nodes_(max_nodes),
      level_(level),
      nodes_(octree_level(cells, level)),
      model_(std::move(states)) {}

SLF_MULTIVERSION_ALL
Result<Done> OctreeDecoder::decode(std::span<const std::uint8_t> payload, int end) {
  RangeDecoder decoder(payload);
  for (; level_ < end; ++level_) {
    model_.start_level(level_);
    std::uint64_t children = 0;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_.occupancy[n] = model_.code(decoder, nodes_, n, 0);
      children += static_cast<std::uint64_t>(std::popcount(nodes_.occupancy[n]));
      if (children > max_nodes_) return Error{Errc::kOutOfRange, "gu_occupancy", 0};
      if (decoder.exhausted()) return decoder.finish("gu_occupancy");
    }
    model_.finish_level(nodes_);
    nodes_ = octree_children(nodes_, level_ + 1 < depth_);
  }
  return decoder.finish("gu_occupancy");
}

}  // namespace slf
