// SPDX-License-Identifier: Apache-2.0
// Splats of one instant after another: what stands still stays as it was.
#pragma once

#include <map>
#include <span>
#include <string>

#include "encoder/train/train_geometry.h"
#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"
#include "slf/capture.h"
#include "slf/error.h"
#include "slf/gaussians.h"

namespace slf {

class ChangedViews;

/// Trains the splats of frames in their order. The first is trained like any capture. Those after
/// it begin as the one before ended, and only splats that changed pixels show are trained, on what
/// is around these pixels: so time and bytes go where something moves, and the rest does not
/// flicker. A change that creeps is found once it has added up (StillPoints).
class SplatsInTime {
 public:
  explicit SplatsInTime(const TrainGeometrySettings& settings) : settings_(settings) {}

  /// @param capture  with points if it is the first; those of others are not looked at. Its
  ///                 origin may be its own
  /// @return places are from the origin of the first; empty: photographs train nothing
  /// @errors those of load_image
  /// The same for any thread count. Holds the photographs of two instants.
  Result<Gaussians, InputError> next(const Capture& capture, std::span<const int> cameras,
                                     const Progress& progress = {});

  /// The first frame's points are anywhere (TrainGeometrySettings::is_volume).
  void set_volume(bool is_volume) { settings_.is_volume = is_volume; }
  /// What the first frame's training found.
  const TrainingCache& cache() const { return cache_; }

 private:
  Result<Done, InputError> begin(const Capture& capture, std::span<const int> cameras,
                                 const Progress& progress);
  Result<Done, InputError> go_on(const Capture& capture, std::span<const int> cameras,
                                 const Progress& progress);

  /// Surfels where outlines have an object and the frame before had none, and photographs changed;
  /// half as many as the first frame has at most.
  Result<Done, InputError> add_what_appears(const Capture& capture, std::span<const int> cameras,
                                            const ChangedViews& changed);

  TrainGeometrySettings settings_;
  TrainingCache cache_;
  Vec3 origin_{};
  std::size_t first_ = 0;  // surfels of the first
  TrainedSurfels surfels_;
  std::map<std::string, TrainingView> before_;  // photographs, as they were when they last changed
};

}  // namespace slf
