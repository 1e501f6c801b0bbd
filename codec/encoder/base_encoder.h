// SPDX-License-Identifier: Apache-2.0
// Mirror of codec/decoder/base_decoder.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/encoder/coefficient_quantiser.h"
#include "codec/encoder/coded_unit.h"
#include "codec/encoder/scene_layout.h"
#include "geometry/occupancy_states.h"

namespace slf {

/// The base as a decoder gets it, for slices to go on from.
struct EncodedBase {
  OccupancyStates geometry;
  std::vector<CodedUnit> units;
  Quantised quantised;
  std::vector<std::int32_t> coefficients;  ///< [cells][planes] quantised
  std::vector<CoefficientModels> models;   ///< one, or none without a base
  std::vector<CoefficientStates> states;   ///< [layers][groups]
};

Result<EncodedBase, InputError> encode_base_geometry(const SliceCoding& coding,
                                                     const SceneLayout& layout);

/// @param input  [cells][planes] of put_into_base
Result<Done, InputError> encode_base_components(const SliceCoding& coding,
                                                const SceneLayout& layout,
                                                std::vector<std::int32_t> input, int threads,
                                                EncodedBase& base);

}  // namespace slf
