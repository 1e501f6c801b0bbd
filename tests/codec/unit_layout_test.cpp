// SPDX-License-Identifier: Apache-2.0
// Which units a stream has, and in which order. Spec 7.1.
#include "codec/unit_layout.h"

#include <gtest/gtest.h>

#include <string>

namespace slf::unit_layout_test {
namespace {

/// Six levels, two of them the base's; two groups, the first in two layers; normals.
SequenceParameterSet two_groups() {
  SequenceParameterSet set;
  set.sps_grid_bits_minus1 = 5;
  set.sps_normal_bits = 8;
  set.sps_base_levels = 2;
  set.sps_num_geometry_ranges_minus1 = 2;
  set.sps_geometry_range_end = {1, 2};
  set.sps_num_functions = 4;
  set.sps_coefficient_coder = kLayeredCoder;
  set.sps_num_groups_minus1 = 1;
  set.sps_num_layers_minus1 = {1, 0};
  set.sps_num_coefficient_ranges_minus1 = 2;
  set.sps_coefficient_range_end = {2, 4};
  return set;
}

/// Type, range, group and layer of every slot, "geometry1"; "coefficients0.1" of group 1.
std::string words(std::span<const UnitSlot> slots) {
  std::string all;
  for (const UnitSlot& slot : slots) {
    all += std::string(all.empty() ? "" : " ") + unit_name(slot.type);
    if (slot.type == UnitType::kGeometry || has_values(slot.type))
      all += std::to_string(slot.range);
    if (has_values(slot.type)) all += "." + std::to_string(slot.group);
    if (slot.layer > 0) all += "." + std::to_string(slot.layer);
  }
  return all;
}

TEST(Spec_7_1_Layout, HasTheRowsOfTheTable) {
  SequenceParameterSet set = two_groups();
  set.sps_transform_flag = 1;
  const UnitLayout layout = layout_of(set);
  EXPECT_EQ(words(slots_of(layout, Owner::kHead)), "sequence transform slices");
  EXPECT_EQ(words(slots_of(layout, Owner::kBase)),
            "geometry0 geometry1 coefficients0.0 coefficients0.1 refinement0.0.1");
  EXPECT_EQ(words(slots_of(layout, Owner::kSlice)),
            "geometry2 normals coefficients1.0 coefficients1.1 coefficients2.0 coefficients2.1 "
            "refinement1.0.1 refinement2.0.1 digest");
  EXPECT_EQ(words(slots_of(layout, Owner::kEnd)), "end");
}

TEST(Spec_7_1_Layout, ACutHasNeitherWhatWasLeftOutNorDigests) {
  SequenceParameterSet set = two_groups();
  set.sps_cut_flag = set.sps_cut_groups = set.sps_cut_layers = 1;
  set.sps_cut_levels = 4;
  const UnitLayout layout = layout_of(set);
  EXPECT_EQ(words(slots_of(layout, Owner::kBase)), "geometry0 geometry1 coefficients0.0");
  EXPECT_EQ(words(slots_of(layout, Owner::kSlice)), "geometry2 normals coefficients1.0");
}

TEST(Spec_7_1_Layout, IsWholeWithoutADigest) {
  const UnitLayout layout = layout_of(two_groups());
  const auto slots = slots_of(layout, Owner::kSlice);
  EXPECT_TRUE(is_whole(slots, slots.size()));
  EXPECT_TRUE(is_whole(slots, slots.size() - 1));
  EXPECT_FALSE(is_whole(slots, slots.size() - 2));
}

TEST(Spec_7_1_Layout, SlotsAndIdsNameEachOther) {
  const UnitLayout layout = layout_of(two_groups());
  for (const Owner owner : {Owner::kBase, Owner::kSlice})
    for (const UnitSlot& slot : slots_of(layout, owner))
      EXPECT_EQ(
          slot_of(slot.type, ids_of(slot, owner == Owner::kBase ? SliceUnitHeader::kBase : 3)),
          slot);
}

}  // namespace
}  // namespace slf::unit_layout_test
