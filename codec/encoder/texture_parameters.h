// SPDX-License-Identifier: Apache-2.0
// What the encoder chooses for textures: the size of cells and the least steps. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace slf {

/// The sps_texture_cell_log2 that leaves the fewest points outside charts; the least of equals, and
/// the first that leaves less than one in 16.
int texture_cell_log2(std::span<const std::uint64_t> morton, int grid_bits);

/// [planes] The least steps for which all values fit samples of `bits`.
std::vector<std::uint32_t> least_texture_steps(std::span<const std::int32_t> components,
                                               std::size_t planes, int bits);

}  // namespace slf
