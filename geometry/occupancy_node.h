// SPDX-License-Identifier: Apache-2.0
// What the decisions about the children of a node have in common. Spec 8.4.2.
#pragma once

#include <array>
#include <cstdint>

namespace slf {

/// What is known of a child before its node is coded, and where its contexts are.
struct OccupancyChild {
  unsigned occupied;  ///< number of cells around it, outside the node
  unsigned corner;
  unsigned slabs;              ///< what they say of it
  std::uint64_t cells;         ///< hash of the cells around it outside the node
  std::uint32_t group;         ///< of 8 contexts by those cells and all but its last 3 siblings
  std::uint32_t in_reference;  ///< hashed context by the cells around it in the reference
};

/// What the decisions of one node have in common.
struct OccupancyNode {
  std::array<OccupancyChild, 8> child;
  std::uint32_t neighbours_class;
  std::uint64_t columns;        // key of their hash
  std::uint32_t columns_group;  // of the contexts of four children
  std::uint32_t next_columns_group;
  std::array<std::int16_t, 8> by_rows;  // what the rows say of each child
};

}  // namespace slf
