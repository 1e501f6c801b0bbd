// SPDX-License-Identifier: Apache-2.0
// Adam: Kingma, Ba, "A method for stochastic optimization" (2015).
#pragma once

#include <vector>

#include "encoder/train/far_surfels.h"
#include "encoder/train/trained_surfel.h"

namespace slf {

/// Moments of the gradients of every surfel's values.
struct AdamState {
  std::vector<TrainedSurfel> mean, square;  ///< [surfels]
  int steps = 0;                            ///< so far: for the bias of the first ones

  void resize(std::size_t surfels);
};

/// One step down the gradients, which may have any scale.
/// @param rates  of each value: about how far a step goes
/// @param space  positions far away go by larger steps: by as many pixels
void adam_step(const std::vector<TrainedSurfel>& gradients, const TrainedSurfel& rates,
               const ViewedSpace& space, int threads, AdamState& state, TrainedSurfels& surfels);

}  // namespace slf
