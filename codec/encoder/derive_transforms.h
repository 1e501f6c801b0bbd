// SPDX-License-Identifier: Apache-2.0
// Transforms across planes, found from the transform coefficients of all slices (Karhunen-Loeve).
// Informative: a decoder reads them from their units.
#pragma once

#include <span>
#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/encoder/forward_transform.h"
#include "codec/encoder/scene_layout.h"
#include "slf/encoder.h"

namespace slf {

/// The sorted integers of all slices.
struct TransformInput {
  std::span<const std::uint64_t> morton;
  std::span<const std::int32_t> components;  ///< [P][planes]
  std::span<const SliceCut> cuts;
  double scale = 1;  ///< points of the scene that each of these stands for
};

/// One transform for the planes of the first group and one for all others, or one where there is
/// one group alone; none where it would not pay, or where components could leave their range.
/// The components of a transform are in the units of its first function, as if all had its norm and
/// shift, and to be quantised with its steps, whatever the function whose plane they stand in.
/// @param first  group; those before it have no transform
/// @param weights  [K] of the squared errors of a component: (norm of the function / 2^shift)^2
/// @param steps  [planes]
/// Floating point: the same matrices for any thread count of one binary. O(P n^2) for n planes or
/// functions; above 2^32 the rows are sampled.
std::vector<ForwardTransform> derive_transforms(const TransformInput& input,
                                                const PlaneGroups& groups, std::size_t first,
                                                const std::vector<double>& weights,
                                                const std::vector<std::uint32_t>& steps,
                                                TransformMode mode, int threads);

/// Codeword of columns of its matrix. Spec 7.11.
std::vector<std::uint8_t> write_columns(const ForwardTransform& transform, ColumnRange columns);

/// Payload of the unit of a transform. Spec 7.11.
Result<std::vector<std::uint8_t>, InputError> write_transform(const ForwardTransform& transform,
                                                              std::uint32_t num_groups);

}  // namespace slf
