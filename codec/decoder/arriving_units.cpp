// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/arriving_units.h"

namespace slf {

Result<Done> ArrivingUnits::take(std::span<const std::uint8_t> bytes, bool ended) {
  while (bytes.size() > walk_.at() && (bytes.size() >= needed_ || ended)) {
    const auto end = end_of_unit(bytes, walk_.at());
    const bool short_of_length = !end && end.error().code == Errc::kTruncated;
    needed_ = end ? *end : 0;
    if ((short_of_length || needed_ > bytes.size()) && !ended && !walk_.complete()) break;
    SLF_TRY(const Unit unit, walk_.next(bytes));
    SLF_CHECK(walk_.take(unit));
    has_headers_ = has_headers_ || unit.type == UnitType::kSlices;
  }
  return Done{};
}

}  // namespace slf
