// A stream is a signature and a sequence of units. Spec 7.1.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "slf/error.h"

namespace slf {

/// No text-mode transfer survives it: a byte above 127, CR LF, end-of-file, LF.
inline constexpr std::array<std::uint8_t, 8> kSignature = {0x8B, 'S',  'L',  'F',
                                                           0x0D, 0x0A, 0x1A, 0x0A};

enum class UnitType : std::uint8_t {
  kSequence = 1,
  kSlices = 2,
  kGeometry = 3,
  kNormals = 4,
  kCoefficients = 5,
  kIndex = 6,
  kMetadata = 7,
  kDigest = 8,
  kTransform = 9,
  kEnd = 15,
};

/// The name `slf info` prints; "unknown" for types of later versions.
const char* unit_name(UnitType type);

struct Unit {
  UnitType type{};
  std::span<const std::uint8_t> payload;
  std::uint64_t offset = 0;  ///< of its first byte in the stream
  std::uint64_t bytes = 0;   ///< with type, length and CRC
};

struct Units {
  std::vector<Unit> units;
  bool complete = false;  ///< the end unit was reached
};

/// Checks signature, lengths and every CRC-32. Unknown types are kept; a decoder skips them.
/// @param max_bytes  units that do not end within it are left out; 0: all
/// @errors kNotSlf; kTruncated: the stream ends inside a unit; kChecksum; kOutOfRange: bytes after
/// the
///         end unit, or a length longer than it need be.
Result<Units> split_units(std::span<const std::uint8_t> stream, std::uint64_t max_bytes = 0);

/// Appends one unit. Informative mirror of the above.
void append_unit(std::vector<std::uint8_t>& stream, UnitType type,
                 std::span<const std::uint8_t> payload);

/// Bytes of a unit with this payload.
std::uint64_t unit_bytes(std::uint64_t payload_bytes);

}  // namespace slf
