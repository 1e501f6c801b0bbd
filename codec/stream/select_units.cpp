// SPDX-License-Identifier: Apache-2.0
#include "codec/stream/select_units.h"

namespace slf {
namespace {

bool is_written_anew(UnitType type) {
  return type == UnitType::kSequence || type == UnitType::kIndex || type == UnitType::kFrame ||
         type == UnitType::kEnd;
}

/// Corrections are of what the whole stream decodes to.
void leave_out_corrections(std::vector<UnitView>& units) {
  std::erase_if(units, [](const UnitView& unit) {
    return is_of_application({unit.type, unit.payload}, kPlenopticCorrections);
  });
}

}  // namespace

Result<SelectedUnits> select_units(const Units& units, const Request& request,
                                   const std::vector<std::uint8_t>& chosen) {
  SelectedUnits kept;
  kept.units.reserve(units.units.size());
  for (const Unit& unit : units.units) {
    if (is_written_anew(unit.type) || unit.type == UnitType::kFiller) continue;
    if (has_ids(unit.type)) {
      SLF_TRY(const SliceUnitHeader ids, read_ids(unit, request.stream.set));
      if (!wants_unit(request, chosen, unit.type, ids)) {
        // A digest, which is of the whole, goes with whatever else does.
        kept.all = kept.all && unit.type == UnitType::kDigest;
        continue;
      }
    }
    kept.units.push_back({unit.type, unit.payload});
  }
  if (!kept.all) leave_out_corrections(kept.units);
  return kept;
}

}  // namespace slf
