// SPDX-License-Identifier: Apache-2.0
// How an encoder divides a scene: levels of the base, and slices. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/code_weights.h"
#include "bitstream/slice_headers.h"
#include "slf/encoder.h"

namespace slf {

/// A run of cells, and its points in the sorted light field.
struct SliceCut {
  std::size_t first_cell = 0;
  std::size_t begin = 0, end = 0;  ///< points
};

struct SceneLayout {
  int base_levels = 0;
  std::vector<std::uint64_t> cells;          ///< codes of the nodes at that level, ascending
  std::vector<std::uint8_t> classes;         ///< [cells] where there is a base, spec 8.4.5
  std::vector<std::uint32_t> weight_before;  ///< [cells + 1] of the cells before each
  std::vector<SliceCut> cuts;
  std::size_t first_slice = 0;  ///< slice_id of the first of them: above 0 of a part of a scene
  SliceTable table;

  CodeWeights weights() const { return CodeWeights(weight_before); }
};

/// @param morton  distinct, ascending codes of the grid
/// @errors kInvalidArgument: what the parameters ask for is not possible with these points.
Result<SceneLayout, InputError> lay_out(std::span<const std::uint64_t> morton, int grid_bits,
                                        const CodingParameters& parameters);

}  // namespace slf
