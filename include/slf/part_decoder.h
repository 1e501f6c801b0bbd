// SPDX-License-Identifier: Apache-2.0
// Decoding parts of a stream that is not in memory: no more of it is read than they need.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "slf/decoder.h"
#include "slf/error.h"
#include "slf/limits.h"
#include "slf/types.h"

namespace slf {

/// Where the bytes of a stream come from.
struct StreamSource {
  std::uint64_t bytes = 0;  ///< of the whole stream
  /// Fills `to` with the bytes from `offset` on, which are within the stream. False: it could not.
  std::function<bool(std::uint64_t offset, std::span<std::uint8_t> to)> read;
};

/// What stands before the first geometry of a stream that has an index and is as long as that says.
struct StreamBeginning {
  std::vector<std::uint8_t> bytes;
  StreamInfo info;  ///< units and bytes of slices are those of the beginning alone; metadata those
                    ///< of the stream
};

/// @return nullopt: there is no such beginning, the stream is to be read whole
/// @errors those of read_info, of the unit of metadata too, wherever it lies. kUnreadable.
///         kLimitExceeded: longer than limits.max_memory
/// Thread-safe as far as the source is.
Result<std::optional<StreamBeginning>> read_beginning(const StreamSource& source,
                                                      const DecodeLimits& limits = {});

/// Reads what levels, groups, layers, max_bytes and region need, and decodes it: what decode() of
/// the whole stream gives with the same options. What is not read is not checked: damage in it goes
/// unseen, which is an error of decode().
///
/// @return nullopt: not less than all is asked for, or less than the beginning; nothing was read
/// @errors those of decode. kOutOfRange index_unit_bytes: a unit is not what the index says.
///         kUnreadable. kLimitExceeded max_memory: of what is to be read, too
/// Source: spec clauses 7.7, 8.9.
Result<std::optional<LightField>> decode_part(const StreamSource& source,
                                              const StreamBeginning& beginning,
                                              const DecodeOptions& options);

}  // namespace slf
