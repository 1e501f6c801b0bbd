// What the encoder chooses for textures: the size of cells and the least steps. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/slice_encoder.h"
#include "slf/types.h"

namespace slf {

/// The sps_texture_cell_log2 that leaves the fewest points outside charts; the least of equals, and
/// the first that leaves less than one in 16.
int texture_cell_log2(std::span<const std::uint64_t> morton, const std::vector<SliceCut>& cuts);

/// [planes] The least steps for which the values of every slice fit samples of `bits`.
std::vector<std::uint32_t> least_texture_steps(std::span<const std::int32_t> components,
                                               std::size_t planes,
                                               const std::vector<SliceCut>& cuts, int bits);

/// The same for the slices that pack() would cut. field: in Morton order.
std::vector<std::uint32_t> least_texture_steps(const LightField& field,
                                               std::uint32_t max_slice_points, int bits);

}  // namespace slf
