// SPDX-License-Identifier: Apache-2.0
// What rounding leaves of exact bytes: a unit of an application type, which decoders of the format
// skip. docs/plenoptic.md has its syntax.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// Bytes of points one after the other, all with `row` of them.
struct ByteRows {
  std::span<const std::uint8_t> bytes;
  std::size_t row = 0;  ///< a multiple of 3
};

/// The payload of the unit.
/// @param exact, near  as many bytes
/// The same for any thread count. O(bytes).
std::vector<std::uint8_t> write_corrections(const ByteRows& exact, const ByteRows& near,
                                            int threads);

/// Whether the payload is of so many points: a part of a file has fewer.
bool corrects(std::span<const std::uint8_t> payload, std::size_t points);

/// Makes exact bytes of near ones, in place.
/// @errors kTruncated, kOutOfRange, kUnsupported: damaged, or of other points
Result<Done> apply_corrections(std::span<const std::uint8_t> payload, std::size_t row,
                               std::span<std::uint8_t> near, int threads);

/// The stream with the unit before its end, known to its index.
/// @errors as read_info
Result<std::vector<std::uint8_t>> with_corrections(std::span<const std::uint8_t> stream,
                                                   std::span<const std::uint8_t> payload);

/// What FrameEncoder takes for the unit of a frame.
std::vector<std::uint8_t> corrections_of_frame(std::span<const std::uint8_t> payload);

/// The payload of the first unit of corrections; empty: there is none.
/// @param stream  a file of one light field, or the bytes of a frame
Result<std::span<const std::uint8_t>> find_corrections(std::span<const std::uint8_t> stream);

}  // namespace slf
