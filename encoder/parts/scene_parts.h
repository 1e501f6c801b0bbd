// SPDX-License-Identifier: Apache-2.0
// Slices of a scene on their way into one file: in memory, and as the streams that parts are.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bitstream/metadata.h"
#include "codec/encoder/coded_unit.h"
#include "encoder/parts/encode_slice.h"
#include "slf/scene.h"

namespace slf {

/// A slice with what the base needs of it.
struct ScenePiece {
  std::vector<CodedUnit> units;  ///< without the digest
  std::optional<CodedUnit> digest;
  std::vector<std::int32_t> sums;  ///< [its cells][planes]
  std::string from;                ///< the name of its part, where it was read
};

/// What parts of one plan have in common, and the slices that are there.
struct SceneParts {
  std::string name;                     ///< where it was read
  std::array<std::uint8_t, 32> plan{};  ///< its digest
  double rdo = 0;
  SequenceParameterSet set;  ///< of the whole: not cut
  SliceTable table;
  std::vector<CodedUnit> head;                      ///< transforms and slices
  std::vector<CodedUnit> base;                      ///< its geometry
  std::vector<std::vector<std::uint8_t>> matrices;  ///< [groups] codewords of columns; or none
  Metadata metadata;
  std::vector<std::optional<ScenePiece>> slices;  ///< [slices]

  std::vector<std::size_t> missing() const;
};

/// Without slices.
Result<SceneParts, InputError> parts_of(const PlannedScene& scene);

/// Moves a slice to its place.
void add_slice(SceneParts& parts, CodedSlice slice);

/// The base of a scene, of the slices that are there.
struct SceneBase {
  SceneLayout layout;
  std::size_t planes = 0;
  std::vector<CodedUnit> units;
};

/// @errors kInvalidInput: its geometry is damaged
/// O(cells planes).
Result<SceneBase, InputError> code_base(const SceneParts& parts, int threads);

/// A stream of the slices that are there. As a part it can be read again and is partial; as a whole
/// it is a light field, partial where slices are missing.
/// @param base  of these slices; of a stream that is only read again any of the same plan
/// @errors those of assemble
Result<std::vector<std::uint8_t>, InputError> join(const SceneParts& parts, const SceneBase& base,
                                                   bool as_part);

/// @errors kInvalidInput: not a part, or a damaged one; names it
/// @param max_memory  of its units; see kMemoryOfPartUnit
Result<SceneParts, InputError> read_part(const PartStream& part,
                                         std::uint64_t max_memory = DecodeLimits::kNone);

/// Bytes of a unit of a slice, however short it is, while parts are joined: as it is kept, and
/// copied to its place.
inline constexpr std::uint64_t kMemoryOfPartUnit = 2 * kMemoryOfUnit;
/// Bytes of what is kept of the slices.
std::uint64_t memory_of(const SceneParts& parts);

/// Adds the slices of another part of the same plan.
/// @errors kInvalidInput: of another plan, or a slice is in both
Result<Done, InputError> combine(SceneParts& parts, SceneParts more);

}  // namespace slf
