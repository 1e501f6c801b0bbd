// SPDX-License-Identifier: Apache-2.0
// The index unit: types, lengths and ids of all units after it, and where slices lie. Spec 7.7.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bitstream/slice_headers.h"
#include "bitstream/units.h"
#include "slf/error.h"

namespace slf {

/// One entry of the index. A range request is planned from the running sum of `bytes`, which begins
/// at the byte after the index unit.
struct IndexEntry {
  UnitType type{};
  std::uint64_t bytes = 0;
  SliceUnitHeader ids;  ///< of types that have ids; without cu_prediction
};

/// Least and greatest x, y, z of a slice's cells, on the grid of sps_base_levels bits.
using CellBox = std::array<std::uint32_t, 6>;

struct Index {
  std::vector<IndexEntry> entries;
  std::vector<CellBox> boxes;  ///< [slices], or none
};

/// @param log  receives every element, where given
Result<Index> parse_index(std::span<const std::uint8_t> payload, const SequenceParameterSet& set,
                          SyntaxLog* log = nullptr);
/// Reads an index from a unit of the stream, which its errors name.
Result<Index> read_index(const Unit& unit, const SequenceParameterSet& set);
/// The payload. @errors kInvalidArgument: an element that a reader would refuse
Result<std::vector<std::uint8_t>, InputError> write_index(const Index& index,
                                                          const SequenceParameterSet& set);

/// The first index unit there is, parsed.
Result<std::optional<Index>> find_index(const Units& units, const SequenceParameterSet& set);

/// Every entry of every index against the units that follow it; a stream that was cut has fewer.
/// The boxes, where there are, against the number of slices.
/// @param slices  0: not known
Result<Done> check_index(const Units& units, const SequenceParameterSet& set, std::size_t slices);

/// Do they name the same slice, range, group and layer?
bool same_ids(const SliceUnitHeader& a, const SliceUnitHeader& b);

/// The ids that a unit begins with.
Result<SliceUnitHeader> read_ids(const Unit& unit, const SequenceParameterSet& set);

}  // namespace slf
