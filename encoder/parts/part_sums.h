// SPDX-License-Identifier: Apache-2.0
// The unit that a part has beside those of a light field: what merging it needs. Decoders skip it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/slice_headers.h"
#include "slf/error.h"

namespace slf {

inline constexpr ApplicationId kPartSums = {'S', 'L', 'F', 'm'};

struct SliceSums {
  std::size_t slice = 0;
  std::vector<std::uint8_t> digest;  ///< 7.9: 32 bytes, or none
  std::vector<std::int32_t> sums;    ///< [its cells][planes] the base's input
};

struct PartSums {
  std::array<std::uint8_t, 32> plan{};
  double rdo = 0;
  std::vector<SliceSums> slices;  ///< ascending
};

std::vector<std::uint8_t> write_part_sums(const PartSums& part);

/// @errors kOutOfRange, kTruncated: part_*
Result<PartSums> parse_part_sums(std::span<const std::uint8_t> payload, const SliceTable& table,
                                 std::size_t planes);

}  // namespace slf
