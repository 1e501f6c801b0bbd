// SPDX-License-Identifier: Apache-2.0
#include "codec/stream/select_units.h"

namespace slf {
namespace {

bool is_written_anew(UnitType type) {
  return type == UnitType::kSequence || type == UnitType::kIndex || type == UnitType::kFrame ||
         type == UnitType::kEnd;
}

}  // namespace

Result<std::vector<CodedUnit>> select_units(const Units& units, const Request& request,
                                            const std::vector<std::uint8_t>& chosen) {
  std::vector<CodedUnit> kept;
  for (const Unit& unit : units.units) {
    if (is_written_anew(unit.type)) continue;
    SliceUnitHeader ids;
    if (has_ids(unit.type)) {
      SLF_TRY(ids, read_ids(unit, request.stream.set));
      if (!wants_unit(request, chosen, unit.type, ids)) continue;
    }
    kept.push_back({unit.type, {unit.payload.begin(), unit.payload.end()}, std::move(ids)});
  }
  return kept;
}

}  // namespace slf
