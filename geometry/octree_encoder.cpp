// SPDX-License-Identifier: Apache-2.0
#include "geometry/octree_encoder.h"

#include <algorithm>
#include <bit>

#include "base/multiversion.h"
#include "entropy/range_encoder.h"
#include "geometry/weight_classes.h"

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

/// The distinct codes without their lower 3 * below bits.
std::vector<std::uint64_t> distinct_cells(std::span<const std::uint64_t> morton, int below) {
  std::vector<std::uint64_t> cells;
  for (const std::uint64_t code : morton)
    if (cells.empty() || cells.back() != code >> (3 * below)) cells.push_back(code >> (3 * below));
  return cells;
}

/// 3 of 4: at half of them or a third, asking first costs bytes (docs/decisions/002).
bool most_have_one_child(const std::vector<std::uint8_t>& occupancy) {
  const auto ones = std::count_if(occupancy.begin(), occupancy.end(),
                                  [](std::uint8_t o) { return std::has_single_bit(o); });
  return 4 * static_cast<std::size_t>(ones) > 3 * occupancy.size();
}

}  // namespace

OctreeEncoder::OctreeEncoder(std::span<const std::uint64_t> morton, int depth,
                             OccupancyStates states, int level)
    : morton_(morton),
      depth_(depth),
      level_(level),
      nodes_(octree_level(distinct_cells(morton, depth - level), level)),
      model_(std::move(states)) {}

SLF_MULTIVERSION_ALL
std::vector<std::uint8_t> OctreeEncoder::encode(int end, std::span<const std::uint8_t> classes) {
  RangeEncoder encoder;
  for (; level_ < end; ++level_) {
    const auto occupancy = occupancies(morton_, nodes_.size(), depth_ - level_);
    model_.start_level(encoder, nodes_, level_, most_have_one_child(occupancy));
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      nodes_.occupancy[n] = model_.code(encoder, nodes_, n, occupancy[n]);
    model_.finish_level(nodes_);
    nodes_ = octree_children(nodes_, !classes.empty() || level_ + 1 < depth_);
  }
  if (!classes.empty()) {
    WeightClassModel model(nodes_);
    for (const std::uint8_t k : classes) model.code(encoder, k);
  }
  return encoder.finish();
}

std::vector<std::vector<std::uint8_t>> encode_octree(std::span<const std::uint64_t> morton,
                                                     int depth, std::span<const int> level_ends) {
  OctreeEncoder encoder(morton, depth, OccupancyStates(morton.size()));
  std::vector<std::vector<std::uint8_t>> payloads;
  for (const int end : level_ends) payloads.push_back(encoder.encode(end));
  return payloads;
}

}  // namespace slf
