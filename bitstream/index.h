// The index unit: types, ids and lengths of all units after it. Spec 7.7.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/units.h"
#include "slf/error.h"

namespace slf {

/// One entry of the index. A range request is planned from the running sum of `bytes`, which begins
/// at the byte after the index unit.
struct IndexEntry {
  UnitType type{};
  std::uint64_t bytes = 0;
};

Result<std::vector<IndexEntry>> parse_index(std::span<const std::uint8_t> payload);
std::vector<std::uint8_t> write_index(const std::vector<IndexEntry>& entries);

/// Every entry against the units that follow units[index_at]; a stream that was cut has fewer.
Result<Done> check_index(const Units& units);

}  // namespace slf
