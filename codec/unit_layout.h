// SPDX-License-Identifier: Apache-2.0
// Table 7-1 as a type: which units a stream has, and in which order. Whatever reads, writes, counts
// or leaves out units walks this list.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/slice_headers.h"

namespace slf {

/// Whose unit it is, in the order of the table.
enum class Owner : std::uint8_t { kHead, kBase, kSlice, kEnd };

/// A row of the table with its numbers. A slot of slices stands for that unit of every slice: a
/// list of all of them would be out of proportion to the bytes of a stream.
struct UnitSlot {
  UnitType type{};
  Owner owner{};
  std::uint32_t range = 0, group = 0, layer = 0;

  bool operator==(const UnitSlot&) const = default;
};

/// Ascending by owner; the slots of an owner in the order of their units.
using UnitLayout = std::vector<UnitSlot>;

/// Spec 7.1, without what sps_cut_flag takes out of the lists.
UnitLayout layout_of(const SequenceParameterSet& set);

std::span<const UnitSlot> slots_of(const UnitLayout& layout, Owner owner);

/// Does an owner with `units` units have all of them? A digest need not be there.
bool is_whole(std::span<const UnitSlot> slots, std::size_t units);

/// The slot that the ids of a unit name.
UnitSlot slot_of(UnitType type, const SliceUnitHeader& ids);

/// The ids of the unit in a slot. slice: or SliceUnitHeader::kBase
SliceUnitHeader ids_of(const UnitSlot& slot, std::uint32_t slice);

}  // namespace slf
