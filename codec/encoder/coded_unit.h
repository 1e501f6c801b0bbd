// SPDX-License-Identifier: Apache-2.0
// Units of a scene on their way into a stream, and what all parts of a scene share.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/encoder/coefficient_quantiser.h"
#include "bitstream/slice_headers.h"
#include "codec/frame_state.h"
#include "codec/unit_layout.h"
#include "slf/encoder.h"

namespace slf {

/// A unit ready to be written.
struct CodedUnit {
  UnitType type{};
  std::vector<std::uint8_t> payload;
  SliceUnitHeader ids;  ///< of a part of the scene
};

/// A unit to be written that lies elsewhere: many short ones take little.
struct UnitView {
  UnitType type{};
  std::span<const std::uint8_t> payload;
};
std::vector<UnitView> views_of(std::span<const CodedUnit> units);

/// What the base and all slices share.
struct SliceCoding {
  const SequenceParameterSet& set;
  PlaneGroups groups;                ///< places of components
  std::vector<std::uint32_t> steps;  ///< [3 R]
  bool digest = true;
  TextureSettings texture;
  double rdo = 0;  ///< CodingParameters
  /// [groups], or none: codewords of their columns, 7.11
  std::vector<std::vector<std::uint8_t>> matrices = {};
  const FrameReference* reference = nullptr;  ///< of a frame that is predicted

  std::size_t planes() const { return steps.size(); }
  /// For the rows of a tree over these codes, from the root.
  QuantiserInput quantiser_input(const RahtTree& tree, std::span<const std::uint64_t> codes) const {
    return {tree, codes, grid_bits(), groups, steps, set.sps_prediction_flag != 0, rdo};
  }
  int grid_bits() const { return static_cast<int>(set.grid_bits()); }
};

/// A unit of the base or of a slice: header and body.
Result<CodedUnit, InputError> part_unit(UnitType type, SliceUnitHeader header,
                                        std::span<const std::uint8_t> body,
                                        const SequenceParameterSet& set);

/// A unit of coefficients, the first of a group with its columns.
Result<CodedUnit, InputError> coefficient_unit(SliceUnitHeader header,
                                               std::vector<std::uint8_t> codeword,
                                               const SliceCoding& coding);

}  // namespace slf
