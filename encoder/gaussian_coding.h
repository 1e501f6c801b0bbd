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

/// Attributes are group 0, so that every cut by groups has them; then harmonics by degree.
/// @param field  of light_field_of()
CodingParameters gaussian_parameters(const LightField& field, const GaussianSteps& steps,
                                     const EncoderSettings& settings);

/// What a decoder gets, in the order of the file.
/// @errors those of decode and gaussians_of
Result<Gaussians, InputError> decoded_gaussians(std::span<const std::uint8_t> stream, int threads);

}  // namespace slf
