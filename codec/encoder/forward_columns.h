// SPDX-License-Identifier: Apache-2.0
// What finds the components of a transform whose matrix is known.
#pragma once

#include <cstdint>
#include <vector>

#include "attributes/encoder/forward_transform.h"

namespace slf {

/// [rows] of the squared errors of what a transform gives, its first function's being 1.
/// @param weights  [K] as derive_transforms has them
std::vector<double> weights_of_rows(const PlaneTransform& t, const std::vector<double>& weights);

/// A transform with what finds its components, from what is coded of it.
/// @param coded      its matrix is there
/// @param weights    [K] as derive_transforms has them
ForwardTransform forward_transform(PlaneTransform coded, std::vector<std::uint8_t> precision,
                                   const std::vector<double>& weights);

}  // namespace slf
