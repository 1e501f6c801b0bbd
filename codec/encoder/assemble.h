// SPDX-License-Identifier: Apache-2.0
// Units to a stream. Spec 7.1, 7.7, 7.10.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "bitstream/index.h"
#include "codec/encoder/coded_unit.h"

namespace slf {

/// The payload of the end unit. Spec 7.10
std::vector<std::uint8_t> end_payload(std::size_t units_before);

/// The sequence unit, of the lowest minor version that has all of it. Spec 7.1.2
/// @errors those of check_sequence_parameter_set
Result<Done, InputError> append_sequence(std::vector<std::uint8_t>& stream,
                                         const SequenceParameterSet& set);

/// Signature, sequence, index, the units, end. sps_level becomes the lowest that admits them.
/// @param boxes  of the index, [slices] or none; nullopt: no index
/// @errors kInvalidArgument: an element of the sequence or the index that a reader would refuse
Result<std::vector<std::uint8_t>, InputError> assemble(
    SequenceParameterSet set, std::span<const UnitView> units,
    const std::optional<std::vector<CellBox>>& boxes);
/// The same of units that were just coded.
Result<std::vector<std::uint8_t>, InputError> assemble(
    const SequenceParameterSet& set, std::span<const CodedUnit> units,
    const std::optional<std::vector<CellBox>>& boxes);

/// Spec 7.1: units of slices in the order of the layout, each of all slices, behind `units`: a
/// beginning is the whole scene, coarse first.
/// @param of_slice  [slices] their units; none of a slice that is missing
void append_slices(std::vector<std::vector<CodedUnit>> of_slice, std::vector<CodedUnit>& units);

/// What a writer gave out, where all that it wrote was read before: then no element is refused.
template <class T>
Result<T> of_what_was_read(Result<T, InputError> written) {
  if (!written) return Error{Errc::kInvalidArgument, "sequence_parameter_set"};
  return *std::move(written);
}

}  // namespace slf
