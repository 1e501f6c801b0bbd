// Streams to be refused: units changed, with sound lengths, CRCs and unit count.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "bitstream/units.h"

namespace slf::conformance {

using Bytes = std::vector<std::uint8_t>;

struct EditableUnit {
  UnitType type;
  Bytes payload;
};

/// A base and several slices, four functions in two groups.
Bytes base_stream(bool index);

/// A stream without an index, its units changed.
Bytes edited(const Bytes& base, const std::function<void(std::vector<EditableUnit>&)>& edit);
Bytes edited(const std::function<void(std::vector<EditableUnit>&)>& edit);

EditableUnit& first_of(std::vector<EditableUnit>& units, UnitType type);

}  // namespace slf::conformance
