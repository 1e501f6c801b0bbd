// SPDX-License-Identifier: Apache-2.0
// Streams to be refused: units changed, with sound lengths, CRCs and unit count.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "slf/encoder.h"

namespace slf::conformance {

using Bytes = std::vector<std::uint8_t>;

struct EditableUnit {
  UnitType type;
  Bytes payload;
};
using UnitList = std::vector<EditableUnit>;
using UnitEdit = std::function<void(UnitList&)>;

/// A base and several slices, four functions in two groups.
Bytes base_stream(bool index);

/// A stream without an index, its units changed.
Bytes edited(const Bytes& base, const UnitEdit& edit);
Bytes edited(const UnitEdit& edit);

/// A coefficient unit with the columns of its group, coded, in place of those it had.
/// before: the sequence it was written for; after: the one it is to be of
/// bytes: what cu_matrix_bytes says; the matrix' own unless given
void set_matrix(EditableUnit& unit, const SequenceParameterSet& before,
                const SequenceParameterSet& after, const Bytes& matrix,
                std::optional<std::uint32_t> bytes = {});
/// A coefficient unit of a slice that says of its levels how they are predicted.
void set_modes(EditableUnit& unit, const SequenceParameterSet& set,
               const std::vector<std::uint32_t>& modes);

/// Without index and digests.
Bytes packed_bare(const LightField& field, CodingParameters parameters);

/// A stream of these units.
Bytes stream_of(const UnitList& units);

void edit_sequence(UnitList& units, const std::function<void(SequenceParameterSet&)>& edit);

EditableUnit& first_of(UnitList& units, UnitType type);

}  // namespace slf::conformance
