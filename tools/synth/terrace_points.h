// SPDX-License-Identifier: Apache-2.0
// The point cloud of a terrace, piece by piece.
#pragma once

#include <functional>

#include "slf/capture.h"
#include "tools/synth/terrace.h"

namespace slf::synth {

/// The step of the lattice (metres) that gives about so many points, on a few per cent.
double terrace_step(const Terrace& terrace, int points, int threads);

/// As sample_points does it, solid by solid: lines along the three axes through a cubic lattice
/// meet the surface of each, and a crossing counts for the axis that its normal is closest to,
/// unless another solid covers it. Lattice and axes are those of the whole scene, so a grid of
/// `step` gets a closed layer. Normals are exact; a colour is the light that leaves the point in
/// all directions, shadows included.
/// @param take  receives the pieces in an order that is always the same, with the share of the
///              scene that is done; on the calling thread. Memory is that of a piece: some 2^21
///              points
void sample_terrace(const Terrace& terrace, double step, int threads,
                    const std::function<void(const PointCloud& piece, double done)>& take);

}  // namespace slf::synth
