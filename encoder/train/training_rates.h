// SPDX-License-Identifier: Apache-2.0
// How far a step of the training goes, and what draws colours that depend on direction to none.
#pragma once

#include <cstdint>
#include <span>

#include "encoder/train/trained_surfel.h"

namespace slf {

struct HarmonicSettings {
  int degree = 2;        ///< 0 .. 3: those above stay 0
  float rate = 1.5e-3f;  ///< step of Adam
  /// Share of that step by which a coefficient is drawn to 0: one that photographs do not agree on
  /// ends there. Of a mean over N photographs noise is 1 / sqrt(N), and so should this be.
  float sparsity = 0;
};

/// Steps of Adam: in the last iterations they fall to a tenth.
/// @param done  share of the iterations, 0 .. 1
/// @param pixel  world units
TrainedSurfel training_rates(double done, double pixel, const HarmonicSettings& harmonics);

/// The proximal step of a penalty of magnitudes of the harmonics: all but the mean colour.
/// @param rates  those of the step that was done
/// @param moving  [surfels] 0: stays as it is; or none
void shrink_harmonics(float sparsity, const TrainedSurfel& rates,
                      std::span<const std::uint8_t> moving, int threads, TrainedSurfels& surfels);

}  // namespace slf
