// SPDX-License-Identifier: Apache-2.0
#include "codec/unit_layout.h"

#include <algorithm>

namespace slf {
namespace {

/// Ranges of coefficients that begin above what a cut left.
std::uint32_t kept_ranges(const SequenceParameterSet& set) {
  std::uint32_t kept = set.coefficient_ranges();
  while (set.sps_cut_flag && kept > 0 && set.coefficient_begin(kept - 1) >= set.sps_cut_levels)
    --kept;
  return kept;
}

/// Rows 4 and 5 of the table, or row 6. The base has the first ranges of either kind.
void add_units_of(Owner owner, const SequenceParameterSet& set, UnitLayout& layout) {
  const bool base = owner == Owner::kBase;
  const std::uint32_t geometry = set.base_geometry_ranges(), kept = kept_ranges(set),
                      values = std::min(set.base_coefficient_ranges(), kept);
  for (std::uint32_t range = base ? 0 : geometry; range < (base ? geometry : set.geometry_ranges());
       ++range)
    layout.push_back({UnitType::kGeometry, owner, range});
  if (!base && set.sps_normal_bits > 0) layout.push_back({UnitType::kNormals, owner});
  for (std::uint32_t layer = 0; layer < set.kept_layers(); ++layer)
    for (std::uint32_t range = base ? 0 : values; range < (base ? values : kept); ++range)
      for (std::uint32_t group = 0; group < set.kept_groups(); ++group)
        if (layer < set.layers_of(group))
          layout.push_back({layer == 0 ? UnitType::kCoefficients : UnitType::kRefinement, owner,
                            range, group, layer});
  if (!base && !set.sps_cut_flag) layout.push_back({UnitType::kDigest, owner});
}

}  // namespace

UnitLayout layout_of(const SequenceParameterSet& set) {
  UnitLayout layout{{UnitType::kSequence, Owner::kHead}};
  if (set.is_empty_frame()) {  // 7.13
    layout.push_back({UnitType::kEnd, Owner::kEnd});
    return layout;
  }
  for (std::uint32_t t = 0; t < set.num_transforms(); ++t)
    layout.push_back({UnitType::kTransform, Owner::kHead});
  layout.push_back({UnitType::kSlices, Owner::kHead});
  add_units_of(Owner::kBase, set, layout);
  add_units_of(Owner::kSlice, set, layout);
  layout.push_back({UnitType::kEnd, Owner::kEnd});
  return layout;
}

std::span<const UnitSlot> slots_of(const UnitLayout& layout, Owner owner) {
  const auto before = [](const UnitSlot& slot, Owner other) { return slot.owner < other; };
  const auto after = [](Owner other, const UnitSlot& slot) { return other < slot.owner; };
  return {std::lower_bound(layout.begin(), layout.end(), owner, before),
          std::upper_bound(layout.begin(), layout.end(), owner, after)};
}

bool is_whole(std::span<const UnitSlot> slots, std::size_t units) {
  return units >= slots.size() || slots[units].type == UnitType::kDigest;
}

UnitSlot slot_of(UnitType type, const SliceUnitHeader& ids) {
  return {type, ids.of_base() ? Owner::kBase : Owner::kSlice, ids.range, ids.group, ids.layer};
}

SliceUnitHeader ids_of(const UnitSlot& slot, std::uint32_t slice) {
  return {slice, slot.range, slot.group, slot.layer, {}};
}

}  // namespace slf
