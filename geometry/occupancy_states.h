// SPDX-License-Identifier: Apache-2.0
// What the decisions of child occupancy have learnt. Spec 8.4.2.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "entropy/context_bit.h"
#include "entropy/context_shape.h"
#include "entropy/mixer.h"

namespace slf {

/// What the decisions of a unit leave to those of the next: a value, so that several slices may
/// start from the same. Spec 8.4.1.
struct OccupancyStates {
  /// points: of all slices; hashed contexts are as many as they can fill.
  explicit OccupancyStates(std::uint64_t points);

  // Tables that are not hashed. Spec table 8-3.
  using Corner = ContextShape<128, 256>;       // of the node; siblings
  using Slabs = ContextShape<64, 256>;         // what the child's say; siblings
  using Places = ContextShape<10, 10, 10, 8>;  // of only children, three axes; place (table 8-4)
  // Sets of weights.
  using BySiblings = ContextShape<8, 256>;   // class of the node's neighbours; siblings
  using ByDensity = ContextShape<22, 27>;    // level; cells around
  using ByRows = ContextShape<16>;           // what the rows say of the child, in halves
  using PlaceByClass = ContextShape<8, 8>;   // place; class of the node's neighbours
  using PlaceByLevel = ContextShape<8, 22>;  // place; level
  using PlaceBySlab = ContextShape<4, 16>;  // axis, 3: none; what the node's slab says, in quarters

  // Rows. Spec table 8-5.
  using CellRows = ContextShape<64>;            // cell of the window
  using NeighbourRows = ContextShape<27, 256>;  // direction; occupancy, 0: not known yet
  static constexpr int kHashedRowBits = 14;
  static constexpr std::uint32_t kHashedRows = CellRows::kCount + NeighbourRows::kCount,
                                 kRows = kHashedRows + (1u << kHashedRowBits);

  // What a predicted frame adds. Spec table 8-6.
  using ReferenceFaces = ContextShape<2, 17, 14, 5, 3>;  // cell, its faces; agreement; siblings'
  using ReferenceSiblings = ContextShape<256, 256>;      // children of the node; siblings
  using ByReference = ContextShape<2, 17, 5, 3>;         // cell; cells around, in halves; as above
  static constexpr std::uint32_t kReferenceRows = kRows, kPredictedRows = kRows + 64 + 256;

  static constexpr int kMostHashedBits = 18;
  static constexpr std::uint32_t kHashed = 3;

  // Found on the clouds of docs/decisions/001.
  static constexpr std::int16_t kFirstWeight = 900;  // of 8192
  static constexpr std::uint32_t kFirstRate = 8, kLastRate = 4;

  std::uint32_t num_nodes = 0;
  std::int32_t rate = kFirstRate;
  int hashed_bits;  ///< log2 of the number of contexts of a hashed table
  std::vector<ContextBit> corner, slabs, beside, latest;
  std::array<std::vector<ContextBit>, kHashed> hashed;
  std::vector<EightLanes> rows, only_rows;  // the latter empty until a level asks for them
  WeightSets by_siblings{BySiblings::kCount, kFirstWeight};
  WeightSets by_density{ByDensity::kCount, kFirstWeight};
  WeightSets by_rows{ByRows::kCount, kFirstWeight};
  WeightSets place_by_class{PlaceByClass::kCount, kFirstWeight};
  WeightSets place_by_level{PlaceByLevel::kCount, kFirstWeight};
  WeightSets place_by_slab{PlaceBySlab::kCount, 0};
  // Empty until a frame is predicted.
  std::vector<ContextBit> reference_faces, reference_siblings, reference_cells;
  WeightSets by_reference{0, 0};

  /// Before a frame that is predicted.
  void add_reference();
  /// The rate sinks as nodes are coded.
  void count_node() {
    rate =
        static_cast<std::int32_t>(kFirstRate - std::min(++num_nodes >> 13, kFirstRate - kLastRate));
  }

  static constexpr int hashed_bits_of(std::uint64_t points) {
    return std::clamp(static_cast<int>(std::bit_width(points)) + 4, 10, kMostHashedBits);
  }
  /// Bytes that states take more once a frame was predicted, at most.
  static constexpr std::size_t kReferenceBytes =
      sizeof(ContextBit) * (ReferenceFaces::kCount + ReferenceSiblings::kCount +
                            (std::size_t{1} << kMostHashedBits)) +
      sizeof(EightLanes) * (2 * (kPredictedRows - kRows) + ByReference::kCount);
  /// Bytes that states for so many points hold.
  static constexpr std::size_t bytes(std::uint64_t points) {
    return sizeof(ContextBit) * (Corner::kCount + Slabs::kCount + 2 * Places::kCount +
                                 (std::size_t{kHashed} << hashed_bits_of(points))) +
           sizeof(EightLanes) *
               (2 * kRows + BySiblings::kCount + ByDensity::kCount + ByRows::kCount +
                PlaceByClass::kCount + PlaceByLevel::kCount + PlaceBySlab::kCount);
  }
};

}  // namespace slf
