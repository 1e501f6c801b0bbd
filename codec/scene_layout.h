// How an encoder divides a scene: levels of the base, and slices. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

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
  std::uint32_t weight = 1;          ///< of a cell in the base
  std::vector<std::uint64_t> cells;  ///< codes of the nodes at that level, ascending
  std::vector<SliceCut> cuts;
  SliceTable table;
};

/// @param morton  distinct, ascending codes of the grid
/// @errors kInvalidArgument: what the parameters ask for is not possible with these points.
Result<SceneLayout, InputError> lay_out(std::span<const std::uint64_t> morton, int grid_bits,
                                        const CodingParameters& parameters);

}  // namespace slf
