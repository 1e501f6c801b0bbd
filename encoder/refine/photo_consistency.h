// SPDX-License-Identifier: Apache-2.0
// What every offset along a point's normal costs: how little the photographs agree there.
#pragma once

#include "encoder/refine/photo_views.h"

namespace slf {

/// Candidate offsets: first + step * i, world units.
struct OffsetRange {
  double first = 0, step = 0;
  std::size_t count = 0;

  float at(std::size_t i) const { return float(first + step * double(i)); }
};

struct ConsistencySettings {
  double spacing = 0;       ///< of a patch's samples, world units
  std::size_t cameras = 8;  ///< most that are compared
  double least_cosine = 0.35;
  double noise = 1;      ///< grey levels: texture weaker than this says little
  double tolerance = 0;  ///< depth, world units: what is hidden
  int threads = 0;
};

/// [(P + every - 1) / every][range.count], of every so many-th point: 0 (all agree) .. about 1
/// (nothing in common)
std::vector<float> photo_costs(std::span<const PhotoView> views, const SurfacePoints& points,
                               double spacing, const OffsetRange& range,
                               const ConsistencySettings& settings, std::size_t every = 1);

}  // namespace slf
