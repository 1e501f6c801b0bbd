// SPDX-License-Identifier: Apache-2.0
// The solids of a terrace: houses, and what stands in the streets.
#pragma once

#include <vector>

#include "tools/synth/solid.h"
#include "tools/synth/terrace_plan.h"

namespace slf::synth {

/// Walls with windows and a door set into them, roof, chimney, and what a house may have besides:
/// some 100 solids.
void build_house(const Lot& lot, std::vector<Solid>& solids);

/// Ground, roads, pavements, lamps, bollards, trees, and a monument at the ends of every street.
void build_streets(const Plan& plan, std::uint32_t seed, std::vector<Solid>& solids);

/// A ball, and an upright cylinder.
Solid ball(const Vec3& centre, double radius, Surface surface, std::uint32_t seed);
Solid pillar(double x, double y, double radius, double z0, double z1, Surface surface,
             std::uint32_t seed);

}  // namespace slf::synth
