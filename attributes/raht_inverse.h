// SPDX-License-Identifier: Apache-2.0
// Dequantisation, inverse transform with prediction, and the means of coarser levels. Spec 8.7.4,
// 8.7.6, 8.8, 8.9.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"
#include "attributes/reference_means.h"
#include "attributes/transform_levels.h"
#include "slf/error.h"

namespace slf {

/// Planes that follow one another and are predicted alike.
struct PredictedPlanes {
  std::size_t begin = 0, end = 0;
  std::vector<std::uint8_t> modes;  ///< [levels.count()] cu_prediction, 0 where none; empty:
                                    ///< all 0
};

inline constexpr std::size_t kAllPlanes = ~std::size_t{0};

/// Values are [rows][planes], row-major; quantised coefficients in, values out, in place.
/// @param steps  [planes]
/// @param nonzero  [rows] 0: the coefficients of the row are zero; empty: any may be other
/// @param used  planes that are worked on: all others from there on are zero
/// @param cells  of a slice, or 0: the first row of each holds a value already, not a coefficient,
///               and merges that join cells are not undone
/// @errors kOutOfRange: a coefficient of 2^27 or more; the values are then of no meaning. The limit
///         bounds every intermediate below 2^31 (spec 8.8.2).
Result<Done> raht_inverse(const RahtTree& tree, std::span<const std::uint32_t> steps,
                          std::span<std::int32_t> values, int threads,
                          std::span<const std::uint8_t> nonzero = {}, std::size_t used = kAllPlanes,
                          std::size_t cells = 0);

/// The same, a level at a time, children predicted.
/// @param levels  of the same points, before the first; of a slice: from its cells on
/// @param planes  ascending, covering all
/// @param reference  of a frame that is predicted, with as many planes; else nullptr
/// @param kept    receives the means of all levels, where given: sized, zero
Result<Done> raht_inverse_predicted(
    const RahtTree& tree, TransformLevels& levels, std::span<const PredictedPlanes> planes,
    std::span<const std::uint32_t> steps, std::span<std::int32_t> values, int threads,
    std::span<const std::uint8_t> nonzero = {}, std::size_t used = kAllPlanes,
    std::size_t cells = 0, const ReferenceMeans* reference = nullptr, LevelMeans* kept = nullptr);

/// The means of a node of `weight` points, of the values raht_inverse leaves in its row; in place.
void to_node_means(std::span<std::int32_t> row, std::uint32_t weight);

}  // namespace slf
