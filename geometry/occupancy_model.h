// SPDX-License-Identifier: Apache-2.0
// The probabilities of child occupancy. One description for decoder and encoder. Spec 8.4.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <utility>

#include "base/by_branch.h"
#include "base/multiversion.h"
#include "base/prefetch.h"
#include "entropy/context_bit.h"
#include "entropy/mixer.h"
#include "geometry/node_view.h"
#include "geometry/occupancy_history.h"
#include "geometry/occupancy_node.h"
#include "geometry/occupancy_rows.h"
#include "geometry/occupancy_slabs.h"
#include "geometry/occupancy_states.h"
#include "geometry/occupancy_window.h"
#include "geometry/octree_levels.h"
#include "geometry/reference_contexts.h"

namespace slf {

class OccupancyModel {
 public:
  explicit OccupancyModel(OccupancyStates states) : states_(std::move(states)) {}

  const OccupancyStates& states() const { return states_; }
  OccupancyStates take_states() { return std::move(states_); }
  void start_from(const OccupancyStates& states) {
    states_ = states;
    if (reference_ != nullptr) states_.add_reference();
  }
  /// All that follows is predicted. reference: kept by pointer
  void predict_from(const MovedReference& reference) {
    reference_ = &reference;
    states_.add_reference();
  }

  /// only: do most nodes of the level have one child only? Spec 8.4.1; the encoder's.
  template <class Coder>
  void start_level(Coder& coder, const OctreeLevel& nodes, int level, bool only = false) {
    history_.start_level(level);
    level_ = static_cast<std::uint32_t>(level);
    if (reference_ != nullptr) walk_.start_level(reference_->cells.level(level + 1));
    sparse_ = nodes.neighbours.size() < 12 * nodes.size();  // spec 8.4.8
    only_ = coder.raw(1, only) != 0;
    if (only_) states_.only_rows.resize(states_.rows.size());
  }
  void finish_level(const OctreeLevel& nodes) {
    history_.finish_level(nodes.morton);
    slabs_.finish_level(nodes.morton, static_cast<int>(level_));
  }

  /// Codes the occupancy of node n. The nodes before it are known, those from n on have 0. The
  /// encoder passes the occupancy, the decoder 0; both get it back: 1 .. 255.
  template <class Coder>
  std::uint8_t code(Coder& coder, const OctreeLevel& nodes, std::size_t n, std::uint8_t occupancy) {
    const NodeView view = view_of(nodes, n, history_);
    if (reference_ != nullptr) in_reference_ = reference_view(*reference_, walk_, level_, view);
    if (only_ && n + 1 < nodes.size())  // for the cache alone
      group(kByNeighbours, nodes.around[n + 1].directions * kFactorA, kOnly, 3);
    unsigned coded = only_ ? code_only(coder, view, nodes, n, occupancy) : 0;
    if (coded == 0)
      coded = reference_ != nullptr ? code_children<true>(coder, view, nodes, n, occupancy)
                                    : code_children<false>(coder, view, nodes, n, occupancy);
    history_.store(static_cast<std::uint8_t>(coded));
    states_.count_node();
    return static_cast<std::uint8_t>(coded);
  }

 private:
  using States = OccupancyStates;

  /// Rows of table 8-3; the first of only children alone (8.4.6).
  enum Hashed { kByNeighbours, kByColumns, kByCells };

  static constexpr unsigned kOnly = 256;  // as the second argument of group()
  /// From here on rows need no contexts. Found on the clouds of docs/decisions/001.
  static constexpr std::int32_t kCertain = 1152;
  static constexpr std::uint64_t kFactorA = 0x9E3779B97F4A7C15u, kFactorB = 0xC2B2AE3D27D4EB4Fu;

  template <bool kPredicted, class Coder>
  unsigned code_children(Coder& coder, const NodeView& view, const OctreeLevel& nodes,
                         std::size_t n, unsigned occupancy) {
    OccupancyNode node = node_contexts<kPredicted>(view);
    const SelectedRows rows = rows_of(view, nodes, n, states_.rows);
    node.by_rows = rows.logistic();
    unsigned coded = 0;
    code_child<kPredicted>(0, coder, node, coded, occupancy);
    code_child<kPredicted>(1, coder, node, coded, occupancy);
    code_child<kPredicted>(2, coder, node, coded, occupancy);
    code_child<kPredicted>(3, coder, node, coded, occupancy);
    code_child<kPredicted>(4, coder, node, coded, occupancy);
    code_child<kPredicted>(5, coder, node, coded, occupancy);
    code_child<kPredicted>(6, coder, node, coded, occupancy);
    if (coded == 0)
      coded = 1u << 7;  // a node has a child: it must be the last
    else
      code_child<kPredicted>(7, coder, node, coded, occupancy);
    rows.update(0xFF, coded, states_.rate);
    if (!kPredicted && sparse_) slabs_.store(view.cell, coded);
    return coded;
  }

  /// Spec 8.4.6: has the node one child only, and which? 0 where it has more.
  template <class Coder>
  unsigned code_only(Coder& coder, const NodeView& view, const OctreeLevel& nodes, std::size_t n,
                     unsigned occupancy) {
    const std::uint32_t by_neighbours = group(kByNeighbours, view.neighbours * kFactorA, kOnly, 3);
    const std::uint32_t by_columns = group(kByColumns, view.columns * kFactorA, kOnly, 3);
    const std::uint32_t by_cells =
        group(kByCells, view.occupied * kFactorA + view.unknown * kFactorB, kOnly, 3);
    const auto beside = [&](unsigned d) { return only_child(view.known[d]); };  // coded before
    ContextBit* const by_beside =
        &states_.beside[States::Places::index(beside(4), beside(10), beside(12), 0)];
    ContextBit* const by_latest = &states_.latest[States::Places::index(
        only_child(view.latest[2]), only_child(view.latest[1]), only_child(view.latest[0]), 0)];
    const SelectedRows rows = rows_of(view, nodes, n, states_.only_rows);
    const std::array<std::int16_t, 8> by_rows = rows.logistic();
    unsigned decided = 0, ones = 0;                              // places, as bits
    const auto code_place = [&](unsigned place, unsigned bit) {  // table 8-4
      const std::array<ContextBit*, 5> selected = {
          by_beside + place, by_latest + place,
          &states_.hashed[kByNeighbours][by_neighbours + place],
          &states_.hashed[kByColumns][by_columns + place],
          &states_.hashed[kByCells][by_cells + place]};
      const SelectedContexts<5> contexts(selected);
      const OccupancySlabs::Place slab = slabs_.place(place, view.cell);
      const EightLanes last(
          std::array<std::int16_t, 8>{0, 0, 0, 0, 0, 0, by_rows[place], slab.input});
      const Mixed<3> mixed(
          contexts.inputs().saturating_plus(last),
          {&states_.place_by_class[States::PlaceByClass::index(place, view.neighbours_class)],
           &states_.place_by_level[States::PlaceByLevel::index(place, level_)],
           &states_.place_by_slab[States::PlaceBySlab::index(slab.axis, slab.sixteenth())]});
      bit = by_branch(coder.bit(mixed.p1(), bit));
      mixed.update(bit, states_.rate);
      contexts.update(bit);
      slab.update(bit);
      decided |= 1u << place;
      ones |= bit << place;
      return bit;
    };
    unsigned coded = 0;
    if (code_place(0, std::has_single_bit(occupancy)) != 0) {
      unsigned child = only_child(occupancy), place = 1;
      for (unsigned axis = 3; axis-- > 0;) place = 2 * place | code_place(place, child >> axis & 1);
      coded = 1u << (place & 7);
    }
    rows.update(decided, ones, states_.rate);
    return coded;
  }

  /// Spec 8.4.7, table 8-5.
  SelectedRows rows_of(const NodeView& view, const OctreeLevel& nodes, std::size_t n,
                       std::vector<EightLanes>& table) {
    SelectedRows rows(table.data(), selected_);
    const auto each = [](auto bits, auto&& add) {
      for (; bits != 0; bits &= bits - 1) add(static_cast<std::size_t>(std::countr_zero(bits)));
    };
    const auto by_neighbour = [&](std::size_t d, unsigned occupancy) {
      rows.add(States::CellRows::kCount + States::NeighbourRows::index(d, occupancy));
    };
    const auto hashed = [&](std::size_t kind, std::uint64_t value) {
      const std::uint64_t h = (kind << 27 | value) * kFactorA;
      rows.add(States::kHashedRows + static_cast<std::size_t>(h >> (64 - States::kHashedRowBits)));
    };
    // One of its own cells stands for the node.
    each(view.occupied | own_cell(0), [&](std::size_t cell) { rows.add(cell); });
    each(view.neighbours & ~view.coded_neighbours, [&](std::size_t d) { by_neighbour(d, 0); });
    if (reference_ != nullptr)
      each(in_reference_.cells, [&](std::size_t cell) { rows.add(States::kReferenceRows + cell); });
    for (std::size_t axis = 0; axis < 3; ++axis)
      hashed(axis, static_cast<std::uint32_t>(view.cell[axis]));
    rows.end_slow();
    if (reference_ != nullptr) rows.add(States::kReferenceRows + 64 + in_reference_.children);
    each(view.coded_neighbours, [&](std::size_t d) { by_neighbour(d, view.known[d]); });
    constexpr std::array<std::size_t, 3> kLower = {12, 10, 4}, kUpper = {14, 16, 22};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint32_t lower = view.known[kLower[axis]];
      hashed(3 + axis, lower << 9 | view.known[kUpper[axis]]);
      hashed(6 + axis, lower << 9 | view.known[kLower[(axis + 1) % 3]]);
      if (view.known[kUpper[axis]] != 0)
        hashed(9 + axis, nodes.around[nodes.neighbour(n, kUpper[axis])].directions);
    }
    hashed(12, view.neighbours);
    return rows;
  }

  template <bool kPredicted>
  OccupancyNode node_contexts(const NodeView& view) {
    OccupancyNode node;
    node.neighbours_class = view.neighbours_class;
    node.columns = view.columns * kFactorA;
    node.columns_group = group(kByColumns, node.columns, 0, 4);
    const std::uint64_t slabs = sparse_ ? slabs_.children(view.cell) : 0;
    SLF_UNROLL_8
    for (unsigned c = 0; c < 8; ++c) {
      OccupancyChild& child = node.child[c];
      const Surroundings around = surroundings(view.occupied, view.unknown, c);
      child.occupied = static_cast<unsigned>(std::popcount(around.occupied));
      child.corner = corner_of(view.neighbours, c);
      child.slabs = slabs >> 8 * c & 255;
      if (c < 6) prefetch(&states_.corner[States::Corner::index(child.corner, 1u << c)]);
      child.cells = around.occupied * kFactorA + (around.unknown << 3 | c) * kFactorB;
      if (c < 4) child.group = group(kByCells, child.cells, 0, 3);
      if constexpr (kPredicted) {
        child.in_reference = hashed_cells(in_reference_, c, states_.hashed_bits);
        prefetch(&states_.reference_cells[child.in_reference]);
      }
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

  /// c: a constant where the function becomes a part of its caller.
  template <bool kPredicted, class Coder>
  SLF_OWN_CALL void code_child(unsigned c, Coder& coder, OccupancyNode& node, unsigned& coded,
                               unsigned occupancy) {
    const unsigned given = occupancy >> c & 1u;
    const std::int32_t by_rows = node.by_rows[c];
    const unsigned bit = std::abs(by_rows) < kCertain
                             ? by_contexts<kPredicted>(c, coder, node, coded, given)
                             : by_branch(coder.bit(bounded_probability(by_rows), given));
    coded |= bit << c;
    // Where the later contexts are is known long before their turn.
    if (c < 4) node.child[c + 4].group = group(kByCells, node.child[c + 4].cells, coded, 3);
    if (c == 2) node.next_columns_group = group(kByColumns, node.columns, 8 | coded, 5);
    if (c == 3) node.columns_group = node.next_columns_group;
  }

  /// coded: the siblings before c. bit: the encoder's.
  template <bool kPredicted, class Coder>
  unsigned by_contexts(unsigned c, Coder& coder, const OccupancyNode& node, unsigned coded,
                       unsigned bit) {
    const OccupancyChild& child = node.child[c];
    const unsigned siblings = 1u << c | coded;  // 1 .. 255: which child, the ones before it
    const unsigned occupied = child.occupied + static_cast<unsigned>(std::popcount(coded));
    // Groups by columns hold four children's contexts, those by cells the last three siblings'.
    const unsigned in_columns = c < 4 ? siblings : (coded & 8) << 1 | 1u << (c & 3) | coded >> 4;
    const unsigned in_cells = c < 4 ? coded : coded >> (c - 3);
    const std::array<ContextBit*, 3> selected = {
        &states_.corner[States::Corner::index(child.corner, siblings)],
        &states_.hashed[kByColumns][node.columns_group + in_columns],
        &states_.hashed[kByCells][child.group + in_cells]};
    const SelectedContexts<3> contexts(selected);
    const std::int16_t by_rows = node.by_rows[c];
    EightLanes* const by_siblings =
        &states_.by_siblings[States::BySiblings::index(node.neighbours_class, siblings)];
    EightLanes* const by_density = &states_.by_density[States::ByDensity::index(level_, occupied)];
    EightLanes* const by_sum =
        &states_.by_rows[States::ByRows::index(std::clamp((by_rows + 1024) >> 7, 0, 15))];
    if constexpr (kPredicted) {
      const ReferenceContexts there =
          select_reference(states_, in_reference_, c, coded, child.in_reference);
      const Mixed<4> mixed(contexts.inputs().saturating_plus(there.lanes(by_rows)),
                           {by_siblings, by_density, by_sum, &there.weights});
      bit = by_branch(coder.bit(mixed.p1(), bit));
      mixed.update(bit, states_.rate);
      there.update(bit);
    } else {
      ContextBit none, &by_slabs = sparse_ ? states_.slabs[child.slabs << 8 | siblings] : none;
      const EightLanes more(std::array<std::int16_t, 8>{0, 0, 0, 0, by_rows, by_slabs.logistic()});
      const Mixed<3> mixed(contexts.inputs().saturating_plus(more),
                           {by_siblings, by_density, by_sum});
      bit = by_branch(coder.bit(mixed.p1(), bit));
      mixed.update(bit, states_.rate);
      by_slabs.update(bit);
    }
    contexts.update(bit);
    return bit;
  }

  const MovedReference* reference_ = nullptr;
  ReferenceWalk walk_;
  ReferenceView in_reference_;
  OccupancyHistory history_;
  OccupancySlabs slabs_;
  SelectedRows::List selected_;
  std::uint32_t level_ = 0;
  bool only_ = false, sparse_ = false;
  OccupancyStates states_;
};

}  // namespace slf
