// SPDX-License-Identifier: Apache-2.0
// Streams of which not all is there: what their index says of the rest, and decoding of pieces.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bitstream/index.h"
#include "bitstream/parameter_sets.h"
#include "bitstream/slice_headers.h"
#include "slf/decoder.h"

namespace slf {

/// A run of bytes of a stream.
struct ByteRange {
  std::uint64_t offset = 0, bytes = 0;
  std::uint64_t end() const { return offset + bytes; }
};

/// The bytes of such a run.
struct StreamPiece {
  std::uint64_t offset = 0;
  std::span<const std::uint8_t> bytes;
};

/// What has to be known of a stream before a part of it can be chosen.
struct StreamHead {
  std::uint64_t bytes = 0;  ///< up to its first unit of geometry; all where there is no index
  bool complete = false;    ///< the stream ends where its index says, with an end unit; without an
                            ///< index not known
};

/// @param begin  the first bytes of a stream
/// @param stream_bytes  of all of it
/// @param max_memory    DecodeLimits::max_memory
/// @return nullopt: more has to be read to tell
Result<std::optional<StreamHead>> find_head(std::span<const std::uint8_t> begin,
                                            std::uint64_t stream_bytes, std::uint64_t max_memory);

/// What is to be read of a stream.
struct ReadPlan {
  bool whole = false;    ///< all of it: it is then decoded by decode()
  bool partial = false;  ///< less comes out than the stream has: LightField::partial. Means alone,
                         ///< which need not all of it, are not less
  SequenceParameterSet set;
  std::uint64_t components = 0, points = 0;  ///< R; at most so many
  DecodeCost cost;                           ///< of what was asked for
  struct Wanted {
    std::uint64_t offset = 0;
    IndexEntry entry;
  };
  std::vector<Wanted> units;      ///< ascending, behind the head
  std::vector<ByteRange> ranges;  ///< theirs, joined

  std::uint64_t bytes() const;
};

/// @param head  the first StreamHead::bytes of the stream, or all of it
/// @param stream_bytes  of all of it
Result<ReadPlan> plan_read(std::span<const std::uint8_t> head, std::uint64_t stream_bytes,
                           const DecodeOptions& options);

/// Decodes what was chosen: as decode() of the whole stream with the same options.
/// @param pieces  [plan.ranges]
/// @errors those of decode; kOutOfRange index_unit_bytes where a piece is not what the index says.
Result<LightField> decode_pieces(std::span<const std::uint8_t> head, const ReadPlan& plan,
                                 std::span<const StreamPiece> pieces, const DecodeOptions& options);

}  // namespace slf
