// SPDX-License-Identifier: Apache-2.0
// Surfels that photographs train: through the renderer, coarse to fine.
#pragma once

#include <filesystem>
#include <functional>
#include <span>
#include <vector>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_rates.h"
#include "encoder/train/training_view.h"
#include "slf/error.h"

namespace slf {

class CameraTwists;
class ChangedViews;

struct TrainSettings {
  int iterations = 3000;    ///< one photograph each
  double from = 0;          ///< 0 .. 1: share of the iterations that was done before
  std::size_t surfels = 0;  ///< most
  int levels = 2;           ///< of photographs: the whole size, and so many halves less one
  double coarse = 0.4;      ///< share of the iterations that each of the halves has
  float structure = 0.2f;   ///< share of SSIM in the loss
  float squared = 0;        ///< share of squared errors in what is left, else absolute ones
  float spread = 1e-3f;     ///< weight of the squared spread in depth, pixels
  float together = 0.03f;   ///< weight of neighbours' distances from each other's planes, pixels
  float decided = 0.02f;    ///< pull of opacities to 0 or 1 in the last third
  float least_opacity = 0.02f;  ///< fainter ones make room for others while surfels grow
  /// Share of the surfels that others take the place of, while surfels grow, where there is no
  /// room.
  double replaced = 0;
  HarmonicSettings harmonics = {};
  CameraTwists* twists = nullptr;  ///< of the views: cameras are learnt, too
  /// Surfels that nothing changed shows stay as they are, to the bit; nullptr: all are trained.
  const ChangedViews* changed = nullptr;
  /// [surfels] 0: is no part of what is trained, and goes. None: all are. Not with `changed`.
  std::function<std::vector<std::uint8_t>(const TrainedSurfels&)> belong = {};
  double seconds = 0;  ///< > 0: the schedule is passed through in so long, if not sooner
  int threads = 0;
  /// Where the training leaves what it would need to go on; empty: nowhere. Not with `seconds`.
  std::filesystem::path work = {};
  bool resume = false;          ///< goes on from there, to the bytes of a training in one go
  double checkpoint_every = 2;  ///< seconds, about
  /// Called now and then with the share that is done; false: no more.
  std::function<bool(double)> progress;
};

inline constexpr float kSolidOpacity = 0.6f;  ///< of surfels that start on a surface

/// Where training begins: as many surfels as the settings allow at first, on the points.
/// @param points  with normals; neither has to be right
/// @param spacing  of the points, world units
/// @param opacity  of each, 0 .. 1
TrainedSurfels start_surfels(const SurfacePoints& points, double spacing,
                             std::span<const TrainingView> views, std::size_t most, float opacity,
                             int threads);

/// World size of a pixel of the views on what they look at; > 0
double training_pixel(std::span<const TrainingView> views);

/// As many surfels as tell apart what photographs do.
std::size_t surfels_for(const SurfacePoints& points, double pixel);

/// Adam on photographs in an order that is drawn once. Surfels that are pulled the most split,
/// those that nothing shows go.
/// @param views  of full size
/// @errors kUnwritable: settings.work
/// The same for any number of threads. O(iterations (pixels + surfels)).
Result<Done, InputError> train_surfels(std::span<const TrainingView> views,
                                       const TrainSettings& settings, TrainedSurfels& surfels);

}  // namespace slf
