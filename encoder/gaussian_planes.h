// SPDX-License-Identifier: Apache-2.0
// Splats as integers: points of a grid with harmonics, a shape and an opacity. Spec 6.8.
#pragma once

#include "slf/error.h"
#include "slf/gaussians.h"
#include "slf/types.h"

namespace slf {

/// Component units of a grey level, and of 1 in a logit or a logarithm: 2^n.
inline constexpr int kHarmonicsShift = 5, kOpacityShift = 10, kShapeShift = 10;

/// @errors kInvalidInput: a grid that pictures cannot hold
Result<Done, InputError> check_drawn(const Grid& grid);

/// Morton codes of the nearest voxels, in the order of the splats.
std::vector<std::uint64_t> codes_of(const Gaussians& splats, const Grid& grid);

/// Least and greatest coordinates. There is a splat.
std::array<Vec3, 2> bounds_of(const Gaussians& splats);

/// The smallest grid of at least this step that holds a box and has a voxel for each of so many
/// splats; coarser where 21 bits would not hold the box.
/// @errors kInvalidInput: no picture shows what is in it: Grid::fits_floats()
Result<Grid, InputError> grid_around(const std::array<Vec3, 2>& bounds, double step,
                                     std::size_t splats);

/// What all light fields of splats of a degree have in common.
LightFieldHeader header_of_splats(const Grid& grid, int degree, UpAxis up);

/// light_field_of() on a given grid, where splats may also be none; those beyond it are moved to
/// its nearest place.
/// @errors kInvalidInput: more splats than the grid has voxels
Result<LightField, InputError> light_field_on(const Gaussians& splats, const Grid& grid,
                                              int threads);

/// The light field that gaussians_of() makes splats of again. Splats are sorted; those that share
/// a voxel move on to the next that is free, along the curve (6.2).
/// @param step  of the grid, world units; coarser where 21 bits would not hold the extent
/// @errors kInvalidInput: there are none, or no picture shows them: Grid::fits_floats().
///         O(P (K + log P)).
Result<LightField, InputError> light_field_of(const Gaussians& splats, double step, int threads);

}  // namespace slf
