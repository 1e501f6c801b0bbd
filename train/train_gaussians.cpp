#include "train/train_gaussians.h"

#include <algorithm>
#include <cmath>

#include "train/tile_pixels.h"
#include "train/train_surfels.h"
#include "train/training_start.h"

namespace slf {
namespace {

constexpr float kThickness = 1e-2f;  // of the lesser deviation: pictures see none

}  // namespace

Gaussians gaussians_of(const TrainedSurfels& surfels) {
  const float reach = std::log(kGaussianReach) / 2;
  Gaussians out;
  out.degree = 2;
  for (const TrainedSurfel& surfel : surfels) {
    const float* v = surfel.value.data();
    out.positions.push_back(surfel.position());
    const float first = v[TrainedSurfel::kLogRadius] - reach,
                second = v[TrainedSurfel::kLogRadius + 1] - reach;
    out.log_deviations.push_back({first, second, std::min(first, second) + std::log(kThickness)});
    const float* turn = v + TrainedSurfel::kTurn;
    const float length =
        std::sqrt(turn[0] * turn[0] + turn[1] * turn[1] + turn[2] * turn[2] + turn[3] * turn[3]);
    out.rotations.push_back(
        {turn[0] / length, turn[1] / length, turn[2] / length, turn[3] / length});
    out.logits.push_back(v[TrainedSurfel::kOpacity]);
    const float* colour = v + TrainedSurfel::kColour;
    out.harmonics.insert(out.harmonics.end(), colour, colour + 3 * kTrainedFunctions);
  }
  return out;
}

Result<Gaussians, InputError> train_gaussians(const Capture& capture, std::span<const int> cameras,
                                              const TrainGeometrySettings& settings,
                                              const Progress& progress) {
  SLF_TRY(TrainingStart start, training_start(capture, cameras, settings, progress));
  if (start.views.empty()) return Gaussians{};
  for (TrainingView& view : start.views) view.camera.gaussian = true;
  TrainSettings& training = start.settings;
  training.spread = training.together = training.decided = 0;
  if (settings.surfels == 0) training.surfels = std::max<std::size_t>(training.surfels / 2, 1);
  TrainedSurfels surfels = first_surfels(start, settings);
  train_surfels(start.views, training, surfels);
  Gaussians out = gaussians_of(surfels);
  out.up = capture.up;
  return out;
}

}  // namespace slf
