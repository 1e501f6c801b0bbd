// SPDX-License-Identifier: Apache-2.0
// What is around an octree node, and latest in its columns. Spec 8.4.2, 8.4.3.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "geometry/morton.h"
#include "geometry/occupancy_history.h"
#include "geometry/occupancy_window.h"
#include "geometry/octree_levels.h"

namespace slf {

struct NodeView {
  Voxel cell;
  std::uint32_t neighbours, neighbours_class;
  std::uint32_t coded_neighbours;  ///< those whose occupancy is known
  Window occupied, unknown;
  std::array<std::uint8_t, 3> latest;
  std::uint64_t columns;
  std::array<std::uint16_t, 27> known;  ///< [direction] 0: no neighbour, 256: one not coded yet
};

/// The 2 x 2 columns along the axis that hold a child, the lower of the other axes first.
inline unsigned occupied_columns(unsigned o, unsigned axis) {
  if (axis == 2) return (o | o >> 4) & 15;
  if (axis == 1) return ((o | o >> 2) & 3) | ((o | o >> 2) >> 2 & 12);
  const unsigned m = o | o >> 1;
  return (m & 1) | (m >> 1 & 2) | (m >> 2 & 4) | (m >> 3 & 8);
}

/// Node n of a level, of which the nodes before it are coded.
inline NodeView view_of(const OctreeLevel& nodes, std::size_t n, OccupancyHistory& history) {
  NodeView view;
  view.known.fill(0);
  // Sums apart from the view: they stay in registers.
  Window occupied = 0, unknown = 0;
  std::uint32_t coded = 0;
  const auto [directions, first] = nodes.around[n];
  const std::uint32_t* neighbour = nodes.neighbours.data() + first;
  for (std::uint32_t left = directions; left != 0; left &= left - 1) {
    const auto d = static_cast<std::size_t>(std::countr_zero(left));
    const unsigned occupancy = nodes.occupancy[*neighbour++];
    const std::uint32_t is_unknown = occupancy == 0;
    const Window part = kWindowParts[d];
    occupied |= turned(kOwnCells[occupancy], kWindowShift[d]) & part;
    unknown |= part & (Window{0} - is_unknown);
    coded |= (is_unknown ^ 1) << d;
    view.known[d] = static_cast<std::uint16_t>(occupancy | is_unknown << 8);
  }
  view.neighbours = directions;
  view.neighbours_class = std::min(static_cast<std::uint32_t>(std::popcount(directions)) / 3, 7u);
  view.coded_neighbours = coded;
  view.occupied = occupied;
  view.unknown = unknown;
  view.cell = from_morton(nodes.morton[n]);
  view.latest = history.at(view.cell);
  view.columns = 1;
  for (unsigned axis = 0; axis < 3; ++axis)
    view.columns = view.columns << 4 | occupied_columns(view.latest[axis], axis);
  return view;
}

/// Which child an occupancy of one has; 8: there is none, 9: there are several.
inline unsigned only_child(unsigned occupancy) {
  if (occupancy == 0) return 8;
  return std::has_single_bit(occupancy) ? static_cast<unsigned>(std::countr_zero(occupancy)) : 9;
}

}  // namespace slf
