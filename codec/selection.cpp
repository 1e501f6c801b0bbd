#include "codec/selection.h"

#include <algorithm>

#include "geometry/morton.h"

namespace slf {

void Selection::choose_slices(const Base& base) {
  if (!plan_.region) return;
  for (std::size_t s = 0; s < slice_.size(); ++s) {
    const auto cells = base.cells_of(plan_.table, s);
    slice_[s] = std::any_of(cells.begin(), cells.end(), [&](std::uint64_t cell) {
      return plan_.meets_region(from_morton(cell), base.level);
    });
  }
  if (plan_.table.shared()) slice_[0] = true;
}

void Selection::choose_slices(std::span<const CellBox> boxes) {
  if (!plan_.region || boxes.size() != slice_.size()) return;
  const int below = plan_.grid_bits() - plan_.base_levels();
  for (std::size_t s = 0; s < slice_.size(); ++s)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::int64_t low = std::int64_t{boxes[s][axis]} << below;
      const std::int64_t high = ((std::int64_t{boxes[s][axis + 3]} + 1) << below) - 1;
      if (high < plan_.region->low[axis] || low > plan_.region->high[axis]) slice_[s] = false;
    }
  if (plan_.table.shared()) slice_[0] = true;
}

bool Selection::all_slices() const {
  return std::find(slice_.begin(), slice_.end(), false) == slice_.end();
}

bool Selection::wants(UnitType type, const SliceUnitHeader& ids) const {
  if (!ids.of_base() &&
      (plan_.base_alone() || ids.slice_id >= slice_.size() || !slice_[ids.slice_id]))
    return false;
  if (type == UnitType::kGeometry)
    return plan_.needs_points() ||
           static_cast<int>(plan_.set.geometry_begin(ids.range)) < plan_.levels;
  if (has_values(type)) return plan_.wants_values(type, ids);
  return type == UnitType::kNormals;
}

SequenceParameterSet cut_sequence(const SequencePlan& plan, bool all_slices) {
  SequenceParameterSet set = plan.set;
  const bool all_groups = plan.groups.size() == set.num_groups();
  set.sps_cut_flag = 1;
  set.sps_cut_levels = static_cast<std::uint32_t>(plan.levels);
  set.sps_cut_groups = all_groups ? 0 : static_cast<std::uint32_t>(plan.groups.size());
  const bool all_layers = plan.layers == static_cast<int>(set.num_layers());
  set.sps_cut_layers = all_layers ? 0 : static_cast<std::uint32_t>(plan.layers);
  set.sps_cut_slices_flag = set.sps_cut_slices_flag || !all_slices;
  return set;
}

}  // namespace slf
