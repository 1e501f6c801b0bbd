// The probabilities of child occupancy. One description for decoder and encoder. Spec 8.4.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/multiversion.h"
#include "base/prefetch.h"
#include "entropy/context_bit.h"
#include "entropy/context_shape.h"
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

/// What the decisions of a unit leave to those of the next: a value, so that several slices may
/// start from the same. Spec 8.4.1.
struct OccupancyStates {
  /// points: of all slices; hashed contexts are as many as they can fill.
  explicit OccupancyStates(std::uint64_t points);

  // Tables that are not hashed. Spec table 8-3.
  using Faces = ContextShape<256, 8>;     // 27 * 8 of them; child
  using Corner = ContextShape<128, 256>;  // of the node; siblings
  // Sets of weights.
  using BySiblings = ContextShape<8, 256>;  // class of the node's neighbours; siblings
  using ByDensity = ContextShape<22, 27>;   // level; cells around
  using ByFaces = ContextShape<27 * 8>;

  static constexpr int kMostHashedBits = 18;
  static constexpr std::uint32_t kHashed = 3;

  // Found on the clouds of docs/rate.md.
  static constexpr std::int16_t kFirstWeight = 900;  // of 8192
  static constexpr std::uint32_t kFirstRate = 8, kLastRate = 4;

  std::uint32_t num_nodes = 0;
  std::int32_t rate = kFirstRate;
  int hashed_bits;  ///< log2 of the number of contexts of a hashed table
  std::vector<ContextBit> faces, corner;
  std::array<std::vector<ContextBit>, kHashed> hashed;
  WeightSets by_siblings{BySiblings::kCount, kFirstWeight};
  WeightSets by_density{ByDensity::kCount, kFirstWeight};
  WeightSets by_faces{ByFaces::kCount, kFirstWeight};

  static constexpr int hashed_bits_of(std::uint64_t points) {
    return std::clamp(static_cast<int>(std::bit_width(points)) + 4, 10, kMostHashedBits);
  }
  /// Of what states for so many points hold.
  static constexpr std::size_t bytes(std::uint64_t points) {
    return sizeof(ContextBit) *
               (Faces::kCount + Corner::kCount + (std::size_t{kHashed} << hashed_bits_of(points))) +
           sizeof(EightLanes) * (BySiblings::kCount + ByDensity::kCount + ByFaces::kCount);
  }
};

class OccupancyModel {
 public:
  explicit OccupancyModel(OccupancyStates states) : states_(std::move(states)) {}

  const OccupancyStates& states() const { return states_; }
  void start_from(const OccupancyStates& states) { states_ = states; }

  void start_level(int level) {
    history_.start_level(level);
    level_ = static_cast<std::uint32_t>(level);
  }
  /// nodes: of the level, all coded.
  void finish_level(const OctreeLevel& nodes) { history_.finish_level(nodes.morton); }

  /// Codes the occupancy of node n. The nodes before it are known, those from n on have 0. The
  /// encoder passes the occupancy, the decoder 0; both get it back: 1 .. 255.
  template <class Coder>
  std::uint8_t code(Coder& coder, const OctreeLevel& nodes, std::size_t n, std::uint8_t occupancy) {
    Node node = node_contexts(nodes, n);
    if (n + 1 < nodes.size())  // for the cache alone
      group(kByNeighbours, nodes.around[n + 1].directions * kFactorA, 0, 4);
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
    constexpr std::uint32_t kFirst = OccupancyStates::kFirstRate,
                            kLast = OccupancyStates::kLastRate;
    states_.rate =
        static_cast<std::int32_t>(kFirst - std::min(++states_.num_nodes >> 13, kFirst - kLast));
    return static_cast<std::uint8_t>(coded);
  }

 private:
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

  using States = OccupancyStates;

  /// Rows of table 8-3.
  enum Hashed { kByNeighbours, kByColumns, kByCells };

  static constexpr std::uint64_t kFactorA = 0x9E3779B97F4A7C15u, kFactorB = 0xC2B2AE3D27D4EB4Fu;

  Node node_contexts(const OctreeLevel& nodes, std::size_t n) {
    Node node;
    const std::uint32_t neighbours = nodes.around[n].directions;
    const std::uint32_t* neighbour = nodes.neighbours.data() + nodes.around[n].first;
    Window occupied = 0, unknown = 0;
    for (std::uint32_t left = neighbours; left != 0; left &= left - 1) {
      const auto d = static_cast<std::size_t>(std::countr_zero(left));
      const unsigned occupancy = nodes.occupancy[*neighbour++];
      occupied |= turned(kOwnCells[occupancy], kWindowShift[d]) & kWindowParts[d];
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
      if (c < 6) prefetch(&states_.corner[States::Corner::index(child.corner, 1u << c)]);
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
        static_cast<std::uint32_t>(h >> (64 - states_.hashed_bits)) >> size_log2 << size_log2;
    prefetch(&states_.hashed[which][first]);
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
    const std::array<ContextBit*, 5> selected = {
        // spec table 8-3
        &states_.faces[States::Faces::index(faces, c)],
        &states_.corner[States::Corner::index(child.corner, siblings)],
        &states_.hashed[kByNeighbours][node.neighbours_group + in_node],
        &states_.hashed[kByColumns][node.columns_group + in_node],
        &states_.hashed[kByCells][child.group + in_cells]};
    const SelectedContexts<5> contexts(selected);
    const Mixed<3> mixed(
        contexts.inputs(),
        {&states_.by_siblings[States::BySiblings::index(node.neighbours_class, siblings)],
         &states_.by_density[States::ByDensity::index(level_, occupied)],
         &states_.by_faces[States::ByFaces::index(faces)]});
    const unsigned bit = coder.bit(mixed.p1(), occupancy >> c & 1u);
    mixed.update(bit, states_.rate);
    contexts.update(bit);
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
  std::uint32_t level_ = 0;
  OccupancyStates states_;
};

}  // namespace slf
