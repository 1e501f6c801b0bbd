// SPDX-License-Identifier: Apache-2.0
// Every element of a stream's headers with its place and value: for writers of other decoders.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "slf/decoder.h"
#include "slf/error.h"
#include "slf/limits.h"

namespace slf {

/// One syntax element of clause 7.
struct ListedElement {
  std::string name;   ///< as in the syntax tables
  std::string kind;   ///< u, ue, se, s8, f64; "bytes": a codeword, metadata, a digest
  std::uint64_t bit;  ///< of its first bit, from the first byte of the stream
  std::uint64_t bits;
  std::string value;  ///< a number; empty for bytes
};

struct ListedUnit {
  std::string type;  ///< as in UnitInfo
  std::uint64_t offset = 0, bytes = 0;
  std::vector<ListedElement> elements;
};

/// The units of a stream in order, each with the elements that stand before its codeword.
/// @errors those of split_units, and the first element that breaks a rule of its own row; what
///         rules over several units say is not looked at. Thread-safe. O(bytes of headers).
Result<std::vector<ListedUnit>> list_syntax(std::span<const std::uint8_t> stream,
                                            const DecodeLimits& limits = {});

/// The same, a unit at a time: `show` gets each, and ends the listing where it gives false. What is
/// before a unit with an error is shown.
/// @param limits  max_memory: of the units, and of the elements of one, 1 KiB for each entry of an
///                index
/// @errors those of list_syntax; kLimitExceeded: max_memory
Result<Done> visit_syntax(std::span<const std::uint8_t> stream, const DecodeLimits& limits,
                          const std::function<bool(const ListedUnit&)>& show);

}  // namespace slf
