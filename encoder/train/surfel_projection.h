// SPDX-License-Identifier: Apache-2.0
// Surfels in one picture, eight at a time: @f[ Q = A A^T + filter^2 I @f] with A the radii in
// pixels; Zwicker et al. (2002).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "encoder/train/draw_surfels.h"

namespace slf {

/// Those from begin to end.
/// @param projected  [surfels] receives them; of opacity 0 where no pixel can show one
/// O(end - begin).
void project_trained(std::span<const TrainedSurfel> surfels, std::size_t begin, std::size_t end,
                     const TrainingCamera& camera, std::span<ProjectedSurfel> projected);

/// Chain rule through project_trained.
/// @param gradients  [projected] with respect to them
/// @param which  of them, of different surfels: memory is read in the surfels' order, best theirs
/// @param sums  [surfels] receives those with respect to the surfels
/// O(which).
void set_trained_gradients(std::span<const TrainedSurfel> surfels, const TrainingCamera& camera,
                           std::span<const ProjectedSurfel> projected,
                           std::span<const ProjectedGradient> gradients,
                           std::span<const std::uint32_t> which, std::span<TrainedSurfel> sums);

}  // namespace slf
