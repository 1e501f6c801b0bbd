// One offset per point from what offsets cost: smooth over the surface, pulled to none where the
// photographs do not say.
#pragma once

#include "refine/photo_consistency.h"

namespace slf {

struct OffsetSettings {
  double smooth = 3;   ///< weight of smoothness
  int rounds = 30;     ///< data and smoothness in turns
  int sweeps = 6;      ///< of smoothing in a round
  double tear = 0.25;  ///< how soon neighbours count less, as their offsets (in steps) differ
  int threads = 0;
};

/// [P] world units
std::vector<float> choose_offsets(const std::vector<float>& costs, const OffsetRange& range,
                                  const Neighbours& neighbours, const OffsetSettings& settings);

}  // namespace slf
