// SPDX-License-Identifier: Apache-2.0
// The surface sampled anew: one point for every lattice line that crosses it.
#pragma once

#include <limits>

#include "capture/surface_points.h"
#include "slf/types.h"

namespace slf {

struct Lattice {
  Vec3 origin{};
  double step = 1;
  std::array<std::int64_t, 3> size{};  ///< nodes per axis; 0: no limit
};

struct ResampleSettings {
  // Lengths in lattice steps.
  int around = 1;        ///< per axis, nodes as near as this to a point are looked at
  double reach = 1.2;    ///< standard deviation of a point's influence
  double support = 1.6;  ///< no node farther than this from every point
  double rim = 1.138;    ///< no surface farther than this from every point
  double off_plane = std::numeric_limits<double>::infinity();   ///< nodes farther from the plane of
                                                                ///< their point are not looked at
  double off_centre = std::numeric_limits<double>::infinity();  ///< no surface farther than this
                                                                ///< from the mean of points there
  bool on_lattice = false;  ///< points at lattice nodes, not on the surface beside them
  int threads = 0;
};

/// A smooth surface through the points (weighted mean of their planes), sampled where it passes a
/// lattice node within half a step along the axis that it faces most. Duplicates vanish, holes of
/// a step or two close; points that agree with no neighbour are gone.
SurfacePoints resample(const SurfacePoints& points, const Lattice& lattice,
                       const ResampleSettings& settings);

}  // namespace slf
