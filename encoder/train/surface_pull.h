// SPDX-License-Identifier: Apache-2.0
// Surfels that lie on one surface pull each other into it: where photographs do not say how deep
// one lies, its neighbours do.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/train/trained_surfel.h"

namespace slf {

/// The nearest others of every surfel.
struct SurfelNeighbours {
  static constexpr std::size_t kCount = 6;
  std::vector<std::uint32_t> index;  ///< [surfels][kCount]; empty: there are too few
};
SurfelNeighbours surfel_neighbours(const TrainedSurfels& surfels, int threads);

/// Adds the gradient of weight * sum of how far neighbours that face the same way are from each
/// other's planes, in pixels, about linear beyond half a pixel. It vanishes on a sphere: planes and
/// chords err alike to either side.
/// @param pixel  world units
void pull_together(const SurfelNeighbours& neighbours, float weight, float pixel, int threads,
                   const TrainedSurfels& surfels, std::vector<TrainedSurfel>& gradients);

}  // namespace slf
