#include "geometry/octree_decoder.h"

#include <bit>

#include "bitstream/multiversion.h"
#include "entropy/range_decoder.h"

namespace slf {

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
    nodes_ = octree_children(nodes_, level_ + 1 < depth_);
  }
  return decoder.finish("gu_occupancy");
}

}  // namespace slf
