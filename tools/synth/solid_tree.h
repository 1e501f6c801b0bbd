// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over solids, so that a ray looks at few of many.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tools/synth/solid.h"

namespace slf::synth {

struct Hit {
  double t;
  SurfacePoint point;
  const Solid* solid;
};

class SolidTree {
 public:
  explicit SolidTree(std::vector<Solid> solids);

  const std::vector<Solid>& solids() const { return solids_; }
  Vec3 low() const { return low_; }
  Vec3 high() const { return high_; }

  /// The first surface in front of the ray's origin, which must be in no solid. O(log solids).
  std::optional<Hit> nearest(const Ray& ray) const;
  /// Is there a surface in front of the ray's origin?
  bool blocked(const Ray& ray) const;
  /// Is the point in any solid?
  bool inside(const Vec3& point) const;

 private:
  /// Floats, rounded outwards. Of an inner node `first` is its second child, the first follows it.
  struct Node {
    std::array<float, 3> low, high;
    std::uint32_t first, count;  ///< count: solids of a leaf; 0: an inner node
  };
  void build(std::uint32_t begin, std::uint32_t end);
  Node node_of(std::uint32_t begin, std::uint32_t end) const;
  template <class Visit>
  void walk(const Probe& probe, const double& end, Visit&& visit) const;

  std::vector<Solid> solids_;  ///< in the order of the leaves
  std::vector<Node> nodes_;
  Vec3 low_, high_;
};

}  // namespace slf::synth
