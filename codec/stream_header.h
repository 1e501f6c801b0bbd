// SPDX-License-Identifier: Apache-2.0
// What a stream is: what its first units say, and which units it has. Spec 7.2, 7.3.
#pragma once

#include <cstdint>

#include "bitstream/slice_headers.h"
#include "codec/unit_layout.h"

namespace slf {

struct StreamHeader {
  SequenceParameterSet set;
  UnitLayout layout;        ///< of set
  SliceTable table;         ///< no slices: the stream ends before it
  std::uint64_t bytes = 0;  ///< of signature and units
  std::uint64_t units = 0;  ///< of all types, and entries of indices
  bool complete = false;    ///< no unit is missing

  int grid_bits() const { return static_cast<int>(set.grid_bits()); }
  int base_levels() const { return static_cast<int>(set.sps_base_levels); }
  bool has_base() const { return base_levels() > 0; }
  /// Slices that the base is added to in the end.
  bool apart() const { return has_base() && table.apart(); }
  /// Cells of the base, 0 where there is none.
  std::uint64_t num_cells() const { return has_base() ? table.num_cells() : 0; }
  /// Bit of a Morton code of the grid that is the lowest of those that join nodes of a level.
  int lowest_split(int level) const { return 3 * (grid_bits() - level); }
  std::span<const UnitSlot> slots(Owner owner) const { return slots_of(layout, owner); }
};

}  // namespace slf
