// SPDX-License-Identifier: Apache-2.0
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
  kRefinement = 10,
  kFrame = 11,
  kFiller = 14,
  kEnd = 15,
};

/// As 7.1 names it, and `slf info`; "type 29" where 7.1 does not.
const char* unit_name(UnitType type);

/// Spec 7.1.1: whose a type is, and whether a decoder that does not know it goes on without the
/// unit, stands in three bits of its number.
inline constexpr unsigned kSkipBit = 64, kPrivateBit = 128, kExperimentBit = 32;

/// What the payload of an application's unit begins with. registry.md
using ApplicationId = std::array<std::uint8_t, 4>;
/// Corrections of what a whole stream decodes to; spec/registry.md.
inline constexpr ApplicationId kPlenopticCorrections = {'S', 'L', 'F', 'p'};
/// The type for applications of this project: a unit that whoever does not know it skips.
inline constexpr auto kApplicationUnit = static_cast<UnitType>(kPrivateBit | kSkipBit);

/// Is the unit, if it is of a type that 7.1 does not name, one that may be skipped?
/// @errors kUnsupported: it has to be understood
Result<Done> check_understood(UnitType type, std::uint64_t offset);

/// The payload of a sequence unit begins behind the version and the length.
struct Unit {
  UnitType type{};
  std::span<const std::uint8_t> payload;
  std::uint64_t offset = 0;          ///< of its first byte in the stream
  std::uint64_t bytes = 0;           ///< with type, length and CRC
  std::uint64_t payload_offset = 0;  ///< of the payload's first byte in the stream
};

/// Bytes of memory that a reader takes for each unit and each entry of an index, however short they
/// are: its own lists while they grow, and those of read_info and truncate. By measurement.
inline constexpr std::uint64_t kMemoryOfUnit = 256;

struct Units {
  std::vector<Unit> units;
  bool complete = false;                     ///< the end unit was reached
  int version_major = 0, version_minor = 0;  ///< of the sequence unit, where there is one

  /// The first of a type; nullptr where there is none.
  const Unit* first(UnitType type) const;
};

/// Checks signature, version, lengths and every CRC-32. Types that 7.1 does not name are kept:
/// check_understood.
/// @param max_bytes   units that do not end within it are left out; 0: all
/// @param max_memory  of units and entries of indices, kMemoryOfUnit each
/// @errors kNotSlf; kUnsupported: another version; kTruncated: the stream ends inside a unit;
///         kChecksum; kOutOfRange: bytes after the end unit, or a length longer than it need be;
///         kLimitExceeded: max_memory.
Result<Units> split_units(std::span<const std::uint8_t> stream, std::uint64_t max_bytes = 0,
                          std::uint64_t max_memory = ~std::uint64_t{0});

/// The units of a stream one after the other, each checked against those before it.
class UnitWalk {
 public:
  /// @param max_memory  of units and entries of indices, kMemoryOfUnit each
  explicit UnitWalk(std::uint64_t max_memory) : left_(max_memory / kMemoryOfUnit) {}

  /// The unit that comes.
  /// @param stream  its beginning up to there, and more
  /// @errors those of read_unit; kOutOfRange: the end unit was taken
  Result<Unit> next(std::span<const std::uint8_t> stream) const;
  /// Goes on behind it.
  /// @errors kLimitExceeded: max_memory; those of check_end
  Result<Done> take(const Unit& unit);

  std::uint64_t at() const { return at_; }     ///< where the unit that comes begins
  bool complete() const { return complete_; }  ///< the end unit was taken

 private:
  std::uint64_t at_ = kSignature.size();
  std::uint64_t left_;     // units and entries of indices that there is memory for
  std::size_t units_ = 0;  // that were taken
  bool complete_ = false;
};

/// Spec 7.10  end_unit( ): no unit was lost.
Result<Done> check_end(std::span<const std::uint8_t> payload, std::size_t units_before);

/// Entries that an index says it has, and has bits for; 0 of any other unit.
std::uint64_t listed_units(const Unit& unit);

/// The unit whose first byte is stream[offset]. Its CRC-32 is checked.
/// @errors kTruncated: the stream ends before it or within it; those of split_units
Result<Unit> read_unit(std::span<const std::uint8_t> stream, std::size_t offset);

/// Where the unit that begins at `offset` ends, by its length: the stream may end before.
/// @errors kTruncated: the length is not all there; those of read_unit
Result<std::uint64_t> end_of_unit(std::span<const std::uint8_t> stream, std::uint64_t offset);

/// An error of a unit as a whole: at its first byte.
Error of_unit(UnitType type, std::uint64_t offset, Errc code, const char* element);
/// An error of an element of the sequence unit, the first of a stream, that is found later.
Error of_sequence(Errc code, const char* element);

/// The error of whoever read a unit's payload and knew nothing else of the stream, as one of the
/// stream. One that is of a unit already stays as it is.
/// @param unit  a Unit, or a PartUnit, of which what follows its header was read
template <class AnyUnit>
Error in_unit(const AnyUnit& unit, Error error) {
  if (*error.unit != 0) return error;
  return {error.code, error.element, 8 * unit.payload_offset + error.bit_offset,
          unit_name(unit.type), error.versions};
}
template <class AnyUnit, class T>
Result<T> in_unit(const AnyUnit& unit, Result<T> result) {
  if (!result) return in_unit(unit, result.error());
  return result;
}

bool is_of_application(const Unit& unit, const ApplicationId& id);
/// What the unit of an application holds behind its identifier.
std::span<const std::uint8_t> application_payload(const Unit& unit);
std::vector<std::uint8_t> with_identifier(const ApplicationId& id,
                                          std::span<const std::uint8_t> payload);

/// Bits of an entry of the index: its type, and the length of the shortest unit, 6, as ue(v).
inline constexpr std::uint64_t kLeastIndexEntryBits = 8 + 5;

/// Appends one unit. version_minor: of a sequence unit
void append_unit(std::vector<std::uint8_t>& stream, UnitType type,
                 std::span<const std::uint8_t> payload, int version_minor = 0);

/// Bytes of a unit with this payload.
std::uint64_t unit_bytes(UnitType type, std::uint64_t payload_bytes);

}  // namespace slf
