// SPDX-License-Identifier: Apache-2.0
#include "geometry/octree_decoder.h"

#include <bit>

#include "base/multiversion.h"
#include "geometry/weight_classes.h"

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

// Inlined into its two callers, which are compiled in several versions. (As a function with
// versions of its own g++ 12 loses its table of exceptions: a failed allocation ends the process.)
inline Result<Done> OctreeDecoder::decode_levels(RangeDecoder& given, int end,
                                                 bool all_neighbours) {
  RangeDecoder decoder = given;  // in registers
  for (; level_ < end; ++level_) {
    model_.start_level(decoder, nodes_, level_);
    std::uint64_t children = 0;
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      nodes_.occupancy[n] = model_.code(decoder, nodes_, n, 0);
      children += static_cast<std::uint64_t>(std::popcount(nodes_.occupancy[n]));
      if (children > max_nodes_) return decoder.here(Errc::kOutOfRange, "gu_occupancy");
      if (decoder.exhausted()) return decoder.finish("gu_occupancy");
    }
    model_.finish_level(nodes_);
    nodes_ = octree_children(nodes_, all_neighbours || level_ + 1 < depth_);
  }
  given = decoder;
  return Done{};
}

SLF_MULTIVERSION_ALL
Result<Done> OctreeDecoder::decode(std::span<const std::uint8_t> payload, int end) {
  RangeDecoder decoder(payload);
  SLF_CHECK(decode_levels(decoder, end, false));
  return decoder.finish("gu_occupancy");
}

SLF_MULTIVERSION_ALL
Result<std::vector<std::uint8_t>> OctreeDecoder::decode_with_classes(
    std::span<const std::uint8_t> payload, int end) {
  RangeDecoder decoder(payload);
  SLF_CHECK(decode_levels(decoder, end, true));
  WeightClassModel model(nodes_);
  std::uint64_t weight = 0;
  for (std::size_t n = 0; n < nodes_.size(); ++n) {
    weight += std::uint64_t{1} << model.code(decoder, 0);
    if (decoder.exhausted()) break;
    if (weight > kMostBaseWeight) return decoder.here(Errc::kOutOfRange, "gu_weight_class");
  }
  SLF_CHECK(decoder.finish("gu_weight_class"));
  return model.classes();
}

}  // namespace slf
