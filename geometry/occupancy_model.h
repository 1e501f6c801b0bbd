// The probabilities of child occupancy. One description for decoder and encoder. Spec 8.4.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bitstream/multiversion.h"
#include "bitstream/prefetch.h"
#include "entropy/context_bit.h"
#include "entropy/mixer.h"
#include "geometry/occupancy_history.h"
#include "geometry/occupancy_window.h"
#include "geometry/octree_levels.h"

namespace slf {

/// The 2 x 2 columns along the axis that hold a child, the lower of the other axes first.
inline unsigned occupied_columns(unsigned o, unsigned axis) {
  if (axis == 2) return (o | o >> 4) & 15;
  if (axis == 1) return ((o | o >> 2) & 3) | ((o | o >> 2) >> 2 & 12);
  const unsigned m = o | o >> 1;
  return (m & 1) | (m >> 1 & 2) | (m >> 2 & 4) | (m >> 3 & 8);
}

class OccupancyModel {
 public:
  /// points: of the slice; hashed contexts are as many as they can fill.
  explicit OccupancyModel(std::uint64_t points);

  void start_level(int level) {
    history_.start_level(level);
    level_ = static_cast<std::uint32_t>(level);
  }

  /// Codes the occupancy of node n. The nodes before it are known, those from n on have 0. The
  /// encoder passes the occupancy, the decoder 0; both get it back: 1 .. 255.
  template <class Coder>
  std::uint8_t code(Coder& coder, const OctreeLevel& nodes, std::size_t n, std::uint8_t occupancy) {
    Node node = node_contexts(nodes, n);
    if (n + 1 < nodes.size())  // for the cache alone
      group(kByNeighbours, nodes.around[n + 1] * kFactorA, 0, 4);
    unsigned coded = 0;
    code_child<0>(coder, node, coded, occupancy);
    code_child<1>(coder, node, coded, occupancy);
    code_child<2>(coder, node, coded, occupancy);
    code_child<3>(coder, node, coded, occupancy);
    code_child<4>(coder, node, coded, occupancy);
    code_child<5>(coder, node, coded, occupancy);
    code_child<6>(coder, node, coded, occupancy);
    if (coded == 0)
      coded = 1u << 7;  // a node has a child: it must be the last
    else
      code_child<7>(coder, node, coded, occupancy);
    history_.store(static_cast<std::uint8_t>(coded));
    rate_ = static_cast<std::int32_t>(kFirstRate -
                                      std::min(++num_nodes_ >> 13, kFirstRate - kLastRate));
    return static_cast<std::uint8_t>(coded);
  }

 private:
  /// log2 of the number of contexts of each table that is not hashed. Spec table 8-3.
  static constexpr int kFacesBits = 11, kCornerBits = 15;
  static constexpr int kMostHashedBits = 18;
  static constexpr std::uint32_t kHashed = 3;

  // Found on the clouds of docs/rate.md.
  static constexpr std::int16_t kFirstWeight = 900;  // of 8192
  static constexpr std::uint32_t kFirstRate = 8, kLastRate = 4;

  /// What is known of a child before its node is coded, and where its contexts are.
  struct Child {
    unsigned faces;     ///< those outside the node
    unsigned occupied;  ///< number of cells around it, outside the node
    unsigned corner;
    std::uint64_t cells;  ///< hash of the cells around it outside the node
    std::uint32_t group;  ///< of 8 contexts by those cells and all but its last 3 siblings
  };

  /// What the decisions of one node have in common.
  struct Node {
    std::array<Child, 8> child;
    std::uint32_t neighbours_class;
    std::uint64_t neighbours, columns;              // hashes of them
    std::uint32_t neighbours_group, columns_group;  // of the contexts of four children
    std::uint32_t next_neighbours_group, next_columns_group;
  };

  /// Rows of table 8-3.
  enum Hashed { kByNeighbours, kByColumns, kByCells };

  static constexpr std::uint64_t kFactorA = 0x9E3779B97F4A7C15u, kFactorB = 0xC2B2AE3D27D4EB4Fu;

  Node node_contexts(const OctreeLevel& nodes, std::size_t n) {
    Node node;
    const std::uint32_t neighbours = nodes.around[n];
    Window occupied = 0, unknown = 0;
    for (std::uint32_t left = neighbours; left != 0; left &= left - 1) {
      const auto d = static_cast<std::size_t>(std::countr_zero(left));
      const unsigned occupancy = nodes.occupancy[static_cast<std::size_t>(nodes.neighbours[n][d])];
      occupied |= std::rotl(kOwnCells[occupancy], kWindowShift[d]) & kWindowParts[d];
      unknown |= occupancy == 0 ? kWindowParts[d] : 0;
    }
    const auto latest = history_.at(nodes.morton[n]);
    std::uint64_t columns = 1;
    for (unsigned axis = 0; axis < 3; ++axis)
      columns = columns << 4 | occupied_columns(latest[axis], axis);
    node.neighbours_class = std::min(static_cast<std::uint32_t>(std::popcount(neighbours)) / 3, 7u);
    node.neighbours = neighbours * kFactorA;
    node.columns = columns * kFactorA;
    node.neighbours_group = group(kByNeighbours, node.neighbours, 0, 4);
    node.columns_group = group(kByColumns, node.columns, 0, 4);
    SLF_UNROLL_8
    for (unsigned c = 0; c < 8; ++c) {
      Child& child = node.child[c];
      const Surroundings around = surroundings(occupied, unknown, c);
      child.faces = outer_faces_of(around, c);
      child.occupied = static_cast<unsigned>(std::popcount(around.occupied));
      child.corner = corner_of(neighbours, c);
      child.cells = around.occupied * kFactorA + (around.unknown << 3 | c) * kFactorB;
      if (c < 4) child.group = group(kByCells, child.cells, 0, 3);
    }
    return node;
  }

  /// Spec 8.4.4: the first of a group of 2^size_log2 hashed contexts, on its way to the cache.
  std::uint32_t group(Hashed which, std::uint64_t a, unsigned coded, int size_log2) const {
    std::uint64_t h = a + coded * kFactorB;
    h = (h ^ h >> 32) * kFactorA;
    const std::uint32_t first =
        static_cast<std::uint32_t>(h >> (64 - hashed_bits_)) >> size_log2 << size_log2;
    prefetch(&hashed_[which][first]);
    return first;
  }

  template <unsigned c, class Coder>
  void code_child(Coder& coder, Node& node, unsigned& coded, unsigned occupancy) {
    const Child& child = node.child[c];
    const unsigned siblings = 1u << c | coded;  // 1 .. 255: which child, the ones before it
    const unsigned faces = child.faces | (coded >> (c ^ 1) & 1) | (coded >> (c ^ 2) & 1) << 1 |
                           (coded >> (c ^ 4) & 1) << 2;
    const unsigned occupied = child.occupied + static_cast<unsigned>(std::popcount(coded));
    // Groups by node hold four children's contexts, those by cells the last three siblings'.
    const unsigned in_node = c < 4 ? siblings : (coded & 8) << 1 | 1u << (c & 3) | coded >> 4;
    const unsigned in_cells = c < 4 ? coded : coded >> (c - 3);
    const std::array<ContextBit*, 5> contexts = {
        // spec table 8-3
        &faces_[faces * 8 + c], &corner_[siblings << 7 | child.corner],
        &hashed_[kByNeighbours][node.neighbours_group + in_node],
        &hashed_[kByColumns][node.columns_group + in_node],
        &hashed_[kByCells][child.group + in_cells]};
    const EightLanes inputs(std::array<std::int16_t, EightLanes::kCount>{
        contexts[0]->logistic(), contexts[1]->logistic(), contexts[2]->logistic(),
        contexts[3]->logistic(), contexts[4]->logistic(), 256});
    const Mixed<3> mixed(inputs, {&by_siblings_[siblings * 8 + node.neighbours_class],
                                  &by_density_[occupied * 22 + level_], &by_faces_[faces]});
    const unsigned bit = coder.bit(mixed.p1(), occupancy >> c & 1u);
    mixed.update(bit, rate_);
    for (ContextBit* const context : contexts) context->update(bit);
    coded |= bit << c;
    // Where the later contexts are is known long before their turn.
    if constexpr (c < 4)
      node.child[c + 4].group = group(kByCells, node.child[c + 4].cells, coded, 3);
    if constexpr (c == 2) {
      node.next_neighbours_group = group(kByNeighbours, node.neighbours, 8 | coded, 5);
      node.next_columns_group = group(kByColumns, node.columns, 8 | coded, 5);
    }
    if constexpr (c == 3) {
      node.neighbours_group = node.next_neighbours_group;
      node.columns_group = node.next_columns_group;
    }
  }

  OccupancyHistory history_;
  std::uint32_t level_ = 0, num_nodes_ = 0;
  std::int32_t rate_ = kFirstRate;
  int hashed_bits_;  // log2 of the number of contexts of a hashed table
  std::vector<ContextBit> faces_, corner_;
  std::array<std::vector<ContextBit>, kHashed> hashed_;
  WeightSets by_siblings_{256 * 8, kFirstWeight};
  WeightSets by_density_{27 * 22, kFirstWeight};
  WeightSets by_faces_{27 * 8, kFirstWeight};
};

}  // namespace slf
