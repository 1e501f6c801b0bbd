// SPDX-License-Identifier: Apache-2.0
// From fitted coefficients to integer components: units, steps and groups. Spec 6.3, 6.5; annex C.
#pragma once

#include <span>
#include <vector>

#include "encoder/fit/fitted_rows.h"
#include "slf/encoder.h"
#include "slf/types.h"

namespace slf {

inline constexpr double kMostStep = CodingParameters::kMostStep;

/// Turns R, G, B coefficients [P][K][3] into the channels of `transform`, in place.
void to_coded_channels(std::span<float> coefficients, ColourTransform transform, int threads);

/// [K] The largest shift up to 6 for which no component of a function is too large for a slice of
/// slice_points. Six bits below a grey level are far below any useful step.
std::vector<int> component_shifts(std::span<const float> coefficients, std::size_t functions,
                                  std::size_t slice_points);
std::vector<int> component_shifts(FittedRows& coefficients, std::size_t functions,
                                  std::size_t slice_points);

/// round(coefficient * 2^shift).
std::vector<std::int32_t> to_components(std::span<const float> coefficients,
                                        const std::vector<int>& shifts, int threads);

/// The same of all pieces, which are given up one after the other: what is held is little more than
/// the components.
std::vector<std::int32_t> to_components(FittedRows coefficients, const std::vector<int>& shifts,
                                        int threads);

/// What a decoder has: R, G, B coefficients [P][K][3].
std::vector<float> decoded_coefficients(const LightField& field, int threads);

/// [K][3] Q, or Q / (2 ||b_k||), in component units, at least 1. The half brings the quality at one
/// Q nearer to that of the uniform step, which spends most of its bits on functions of small norm.
std::vector<std::array<std::uint32_t, 3>> quantiser_steps(const Basis& basis,
                                                          const std::vector<int>& shifts, double q,
                                                          bool by_norm);

/// [K][3] Steps for a texture: uniform, or inverse to the norms, and the smallest of that kind that
/// are nowhere below `least` ([3 K], texture_parameters.h).
std::vector<std::array<std::uint32_t, 3>> texture_steps(const Basis& basis,
                                                        const std::vector<int>& shifts,
                                                        std::span<const std::uint32_t> least,
                                                        bool by_norm);

/// [K] The mean alone, then rectangles of scales: N = 1, 8, 32, 128, ... functions for s0 = s1 + 1;
/// of harmonics degrees 1 - 2, 3 - 5, 6 and above.
std::vector<int> scale_groups(const Basis& basis);

}  // namespace slf
