// The units of a stream by what they belong to. Spec 7.1, 8.2.
#pragma once

#include <vector>

#include "bitstream/parameter_sets.h"
#include "bitstream/units.h"
#include "codec/slice_decoder.h"

namespace slf {

/// The sequence unit, which must come first.
/// @errors kTruncated where there is no unit at all; kOutOfRange where another comes first or a
/// second
///         one follows; those of parse_sequence_parameter_set.
Result<SequenceParameterSet> find_sequence(const Units& units);

/// Reads the header that a unit of a slice begins with.
Result<SliceUnit> read_slice_unit(const Unit& unit, const SequenceParameterSet& set);

/// Slices in stream order, each with its units. Checks order: cubes ascending and disjoint, ids
/// counting up from 0, units after their slice unit.
Result<std::vector<SliceDecoder>> collect_slices(const Units& units,
                                                 const SequenceParameterSet& set);

}  // namespace slf
