// SPDX-License-Identifier: Apache-2.0
// Which steps, groups and levels splats are coded with.
#pragma once

#include <cstdint>
#include <span>

#include "slf/encoder.h"
#include "slf/gaussians.h"
#include "slf/types.h"

namespace slf {

/// Steps of one quality: of harmonics in grey levels, of logits, of logarithms of deviations.
struct GaussianSteps {
  double colour, opacity, shape;
};

GaussianSteps steps_of(double q);

/// @errors kInvalidArgument: a setting out of its range, with its name; coders that splats do not
///         have
Result<Done, InputError> check_coding_of_splats(const EncoderSettings& settings);

/// The splats that the reference rasteriser draws: of an opacity of 1 / 255 and more.
Gaussians that_show(Gaussians splats);

/// The median deviation along the middle axis, world units. There is a splat.
double typical_deviation(const Gaussians& splats);

/// Side of voxels of which splats occupy three for every four places that they have: of coarser
/// ones too few are free, and splats would be moved far away. Places that the finest grid does not
/// tell apart are one: copies stay crowded. Infinite: there is one place.
/// @param deviation  typical_deviation()
double room_of(const Gaussians& splats, double deviation);

/// What a grid goes by.
struct SplatSizes {
  double deviation = 0;  ///< typical_deviation()
  double room = 0;       ///< room_of()
  double extent = 0;     ///< the longest side of the box of all splats
};

/// The step of the grid that goes with a quality, unless settings say another.
double grid_step_of(double q, const SplatSizes& sizes, const EncoderSettings& settings);

/// The quality, behind what settings have.
Metadata metadata_of_gaussians(double q, const EncoderSettings& settings);

/// Level ends for splats that stand alone long before the finest level: at the levels where they
/// are a sixth, a third and three quarters of their number. O(P).
/// @param positions  in Morton order
std::vector<int> splat_level_ends(std::span<const Voxel> positions, int bits);

/// Attributes are group 0, so that every cut by groups has them; then harmonics by degree.
/// @param header  of header_of_splats()
/// @param ends    of levels, of both geometry and coefficients
CodingParameters gaussian_parameters(const LightFieldHeader& header, const GaussianSteps& steps,
                                     const std::vector<int>& ends, const EncoderSettings& settings);

/// What a decoder gets, in the order of the file.
/// @errors those of decode and gaussians_of
Result<Gaussians, InputError> decoded_gaussians(std::span<const std::uint8_t> stream, int threads);

}  // namespace slf
