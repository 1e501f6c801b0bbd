// SPDX-License-Identifier: Apache-2.0
// Streams that say something else of themselves, without decoding and coding again.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "slf/error.h"
#include "slf/limits.h"

namespace slf {

/// What a stream is to say of itself.
struct Annotations {
  /// Keys with their new values, in this order behind those that stay; a key without a value goes.
  std::vector<std::pair<std::string, std::optional<std::string>>> metadata;
  std::optional<double> metres_per_unit;  ///< 0: not known; without a value it stays
};

/// Writes a stream's metadata and scale anew. All units of points and values stay byte for byte,
/// and with them what decode() gives and its digests; the index is written anew. A stream without
/// an end unit has no index then. Of frames, the first is annotated and each that begins a group
/// and has metadata; the others stay as they are. Fillers are left out.
/// @param limits  max_stream_bytes, and what decode() takes of them for headers
/// Thread-safe. O(bytes)
/// @errors those of headers as decode; kInvalidArgument: "metadata" where it has a key without a
///         name, zero bytes, more than 1 MiB, or is not UTF-8; "metres_per_unit" that is below 0
///         or no number
Result<std::vector<std::uint8_t>> annotate(std::span<const std::uint8_t> stream,
                                           const Annotations& annotations,
                                           const DecodeLimits& limits = {});

/// A stream as pieces that follow each other: those that stay are of the stream it was made of, so
/// that a long film is not in memory twice.
struct AnnotatedPieces {
  std::vector<std::vector<std::uint8_t>> written;     ///< what is new
  std::vector<std::span<const std::uint8_t>> pieces;  ///< of the stream and of `written`

  AnnotatedPieces() = default;
  AnnotatedPieces(AnnotatedPieces&&) = default;  // a copy's pieces would be of the first's bytes
  AnnotatedPieces& operator=(AnnotatedPieces&&) = default;
  std::size_t bytes() const;
};

/// The bytes of annotate(). The stream has to outlive them. Frames that say nothing of themselves
/// stay where they are; a light field that does not move is written anew.
Result<AnnotatedPieces> annotate_in_pieces(std::span<const std::uint8_t> stream,
                                           const Annotations& annotations,
                                           const DecodeLimits& limits = {});

}  // namespace slf
