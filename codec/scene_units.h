// SPDX-License-Identifier: Apache-2.0
// The units of a stream by what they belong to: the base of the scene, or a slice. Spec 7.1, 8.2.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "bitstream/metadata.h"
#include "bitstream/slice_headers.h"
#include "bitstream/units.h"
#include "codec/stream_header.h"
#include "slf/limits.h"

namespace slf {

/// A unit of the base or of a slice with its header read.
struct PartUnit {
  UnitType type{};
  SliceUnitHeader header;
  std::span<const std::uint8_t> matrix;   ///< codeword of the group's columns, 7.11
  std::span<const std::uint8_t> payload;  ///< what follows the header, and the matrix
  std::uint64_t offset = 0;               ///< of the unit in the stream
  std::uint64_t payload_offset = 0;       ///< of what follows the header
};

/// Those of the base, or of one slice, in stream order: geometry, normals, coefficients,
/// refinements, digest.
using PartUnits = std::vector<PartUnit>;

struct SceneUnits {
  StreamHeader stream;
  PartUnits base;
  std::vector<PartUnits> slices;
};

/// The sequence unit, which must come first.
/// @errors kTruncated where there is no unit at all; kOutOfRange where another comes first or a
/// second one follows; those of parse_sequence_parameter_set.
Result<SequenceParameterSet> find_sequence(const Units& units);

/// Reads the one metadata unit; empty where there is none.
/// @errors kOutOfRange: a second one; those of parse_metadata.
Result<Metadata> collect_metadata(const Units& units);

/// Reads the header that a unit of the base or of a slice begins with.
Result<PartUnit> read_part_unit(const Unit& unit, const SequenceParameterSet& set);

/// Checks that the units of every owner are a beginning of its slots, and all of them where the
/// stream is complete and not cut.
/// @errors kOutOfRange: a unit out of its place; those of the slices unit and of headers
Result<SceneUnits> collect_units(const Units& units, const SequenceParameterSet& set);

/// The units of a stream in its order, and by owner.
struct OpenStream {
  Units units;
  SceneUnits scene;
};

/// Spec 7.1 - 7.7: the headers of all units, each in its place, and what an index says of them.
/// @param max_bytes  units that do not end within it are left out; 0: all
/// @errors kLimitExceeded: limits.max_stream_bytes; those of units, headers and index
Result<OpenStream> open_stream(std::span<const std::uint8_t> stream, const DecodeLimits& limits,
                               std::uint64_t max_bytes = 0);

}  // namespace slf
