// SPDX-License-Identifier: Apache-2.0
// Poses in training: what each camera sees is moved and turned a little before it sees it.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"

namespace slf {

/// Moves `pivot + at` to `pivot + at + turn x at + move`, in the world.
using CameraTwist = std::array<double, 6>;  ///< move, turn (radians)

/// The twists of all views, and how they are learnt: Adam, by what surfels are pulled in the view's
/// own picture. A scene that is moved and a camera that is moved the other way look the same.
class CameraTwists {
 public:
  CameraTwists() = default;
  /// @param pixel  world size of a pixel: TrainingCamera's
  CameraTwists(std::size_t views, const TrainedSurfels& surfels, double pixel);

  bool empty() const { return twists_.empty(); }
  /// The camera that sees the world as `given` sees the moved one. Of any size of the photograph.
  TrainingCamera camera(std::size_t view, const TrainingCamera& given) const;
  /// A step of `rate` pixels.
  /// @param gradients  of the surfels, by this view's picture alone
  void step(std::size_t view, double rate, const TrainedSurfels& surfels,
            const std::vector<TrainedSurfel>& gradients);
  /// Takes off what all have in common: the scene is where cameras have it in the mean.
  void centre();

  /// All that step() and centre() change, [views][19], for a checkpoint; none where it is empty.
  std::vector<double> state() const;
  /// @param state  of the same views
  void go_on_from(std::span<const double> state);

  const CameraTwist& twist(std::size_t view) const { return twists_[view]; }
  const Vec3& pivot() const { return pivot_; }

 private:
  Vec3 pivot_{};
  CameraTwist unit_{};  ///< a pixel's worth of each
  std::vector<CameraTwist> twists_, mean_, square_;
  std::vector<int> steps_;
};

/// The same of a camera of the capture.
Camera twisted(const Camera& camera, const CameraTwist& twist, const Vec3& pivot);

}  // namespace slf
