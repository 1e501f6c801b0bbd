// SPDX-License-Identifier: Apache-2.0
// What photographs of an instant show that those of the instant before do not.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"

namespace slf {

/// Photographs of two instants, compared camera by camera. Only what is around a change is kept.
class ChangedViews {
 public:
  /// @param before  each pixel as it was when it last changed; becomes `now` where that differs
  /// @param now     as many; where the camera is another one, all of it has changed
  ChangedViews(std::vector<TrainingView>& before, std::vector<TrainingView> now, int threads);

  /// Boxes around what changed, of the photographs that show a change.
  const std::vector<TrainingView>& views() const { return views_; }

  /// [surfels] 1: it shows, as they are now, in pixels that changed. O(surfels + pixels)
  std::vector<std::uint8_t> shown_by(const TrainedSurfels& surfels, int threads) const;

 private:
  std::vector<TrainingView> views_;
  std::vector<TrainingView> marks_;  // of a quarter of their sides: the share that has changed
};

}  // namespace slf
