// SPDX-License-Identifier: Apache-2.0
// What the reference of a predicted frame says of one child. Spec 8.12.3.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "geometry/occupancy_states.h"
#include "geometry/reference_view.h"

namespace slf {

/// Three contexts, in the lanes behind those of table 8-3, and a set of weights.
struct ReferenceContexts {
  ContextBit &density, &siblings, &cells;
  EightLanes& weights;

  /// by_rows: of the lane before them
  EightLanes lanes(std::int16_t by_rows) const {
    return EightLanes(std::array<std::int16_t, 8>{0, 0, 0, 0, by_rows, density.logistic(),
                                                  siblings.logistic(), cells.logistic()});
  }
  void update(unsigned bit) const {
    density.update(bit);
    siblings.update(bit);
    cells.update(bit);
  }
};

/// Which context the 3 x 3 x 3 cells around a child select.
inline std::uint32_t hashed_cells(const ReferenceView& view, unsigned c, int hashed_bits) {
  constexpr std::uint64_t kFactor = 0x9E3779B97F4A7C15u;
  std::uint64_t h = (view.around(c) << 3 | c) * kFactor;
  h = (h ^ h >> 32) * kFactor;
  return static_cast<std::uint32_t>(h >> (64 - hashed_bits));
}

/// coded: the siblings before child c. cells: the hashed context by what is around it there
inline ReferenceContexts select_reference(OccupancyStates& states, const ReferenceView& view,
                                          unsigned c, unsigned coded, std::uint32_t cells) {
  using States = OccupancyStates;
  const unsigned there = view.children >> c & 1u, density = view.density(c), before = (1u << c) - 1;
  const auto wrong =
      std::min(static_cast<unsigned>(std::popcount((view.children ^ coded) & before)), 2u);
  const auto count = static_cast<unsigned>(std::popcount(view.around(c) & kAllAround));
  return {
      states.reference_faces[States::ReferenceFaces::index(there, density, count / 2,
                                                           view.agreement, wrong)],
      states.reference_siblings[States::ReferenceSiblings::index(view.children, 1u << c | coded)],
      states.reference_cells[cells],
      states.by_reference[States::ByReference::index(there, density, view.agreement, wrong)]};
}

}  // namespace slf
