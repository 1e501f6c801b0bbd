// SPDX-License-Identifier: Apache-2.0
// Streets of terraced houses: a scene of any size, with windows, wet stones and metal that look
// different from everywhere.
#pragma once

#include "tools/synth/scene.h"
#include "tools/synth/solid_tree.h"
#include "tools/synth/terrace_plan.h"

namespace slf::synth {

class Terrace final : public Subject {
 public:
  /// The same for the same arguments.
  /// @param houses  1 .. 10000
  Terrace(int houses, std::uint64_t seed);

  const Plan& plan() const { return plan_; }
  const SolidTree& tree() const { return tree_; }

  double radius() const override;  ///< the sky is everywhere
  bool radiance(const Ray& ray, Colour& light, double& transmittance) const override;

  /// Is the point of the surface of a solid one that light reaches: outside of all other solids,
  /// and above the ground?
  bool exposed(const SurfacePoint& point) const;
  /// Light from a point of a solid's surface that is the same in all directions; display 0 .. 1 of
  /// it is what a scanner's camera would say of the point.
  Colour diffuse(const Solid& solid, const SurfacePoint& point, double footprint) const;

 private:
  struct Lit;
  Lit lit(const Solid& solid, const SurfacePoint& point, double footprint) const;
  Colour reflected(const Vec3& from, const Vec3& direction, double footprint) const;
  double openness(const SurfacePoint& point) const;

  Plan plan_;
  SolidTree tree_;
};

}  // namespace slf::synth
