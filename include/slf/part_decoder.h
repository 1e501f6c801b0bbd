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
  StreamInfo info;  ///< units, bytes of slices and metadata are those of the beginning alone
};

/// @return nullopt: there is no such beginning, the stream is to be read whole
/// @errors those of read_info. kUnreadable. kLimitExceeded: longer than limits.max_memory
/// Thread-safe as far as the source is.
Result<std::optional<StreamBeginning>> read_beginning(const StreamSource& source,
                                                      const DecodeLimits& limits = {});

/// The metadata, which most streams have at their end: read where the index says.
/// @return those of the beginning, where it has some; none: there are none
/// @errors kUnreadable; those of a damaged unit; kOutOfRange index_unit_bytes: another unit is there
/// Thread-safe as far as the source is.
Result<Metadata> read_metadata(const StreamSource& source, const StreamBeginning& beginning,
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
