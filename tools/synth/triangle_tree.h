// SPDX-License-Identifier: Apache-2.0
// A tree of boxes over triangles: what a ray meets first.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "tools/synth/vec.h"

namespace slf::synth {

struct TriangleHit {
  double t;
  std::uint32_t triangle;
  double b, c;  ///< weights of the second and the third corner; the first has the rest
};

class TriangleTree {
 public:
  using Corners = std::array<Vec3, 3>;
  /// O(triangles log triangles).
  explicit TriangleTree(std::vector<Corners> triangles);

  /// The nearest in front of the ray's origin, from either side. O(log triangles).
  std::optional<TriangleHit> nearest(const Ray& ray) const;

 private:
  struct Node {
    Vec3 low, high;
    std::uint32_t first, count;  ///< count 0: an inner node, `first` is its second child
  };
  void build(std::uint32_t begin, std::uint32_t end);
  void test(std::uint32_t at, const Ray& ray, double& end, std::optional<TriangleHit>& hit) const;

  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> order_;  ///< triangles in the order of the leaves
  std::vector<Node> nodes_;
};

}  // namespace slf::synth
