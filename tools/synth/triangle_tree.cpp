// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/triangle_tree.h"

#include <limits>
#include <numeric>

namespace slf::synth {
namespace {

constexpr std::uint32_t kLeafTriangles = 4;  // at most
constexpr double kNowhere = std::numeric_limits<double>::infinity();

/// Where the ray enters a box before `end`; infinite: it does not.
double enters(const Vec3& low, const Vec3& high, const Ray& ray, const Vec3& inverse, double end) {
  double enter = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (low[k] - ray.origin[k]) * inverse[k];
    const double b = (high[k] - ray.origin[k]) * inverse[k];
    // In this order a NaN, of a ray within a face, leaves the bounds as they were.
    enter = std::max(enter, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return enter <= end ? enter : kNowhere;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<Corners> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
  std::iota(order_.begin(), order_.end(), 0u);
  if (!order_.empty()) build(0, static_cast<std::uint32_t>(order_.size()));
}

void TriangleTree::build(std::uint32_t begin, std::uint32_t end) {
  Node node{{kNowhere, kNowhere, kNowhere}, {-kNowhere, -kNowhere, -kNowhere}, begin, end - begin};
  Vec3 least = node.low, most = node.high;  // of the centres, times three
  const auto centre = [this](std::uint32_t i, std::size_t k) {
    return triangles_[i][0][k] + triangles_[i][1][k] + triangles_[i][2][k];
  };
  for (std::uint32_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Vec3& corner : triangles_[order_[i]]) {
        node.low[k] = std::min(node.low[k], corner[k]);
        node.high[k] = std::max(node.high[k], corner[k]);
      }
      least[k] = std::min(least[k], centre(order_[i], k));
      most[k] = std::max(most[k], centre(order_[i], k));
    }
  const std::size_t here = nodes_.size();
  nodes_.push_back(node);
  if (end - begin <= kLeafTriangles) return;
  const Vec3 width = most - least;
  const auto axis =
      static_cast<std::size_t>(std::max_element(width.begin(), width.end()) - width.begin());
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(
      order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
      [&](std::uint32_t a, std::uint32_t b) { return centre(a, axis) < centre(b, axis); });
  nodes_[here].count = 0;
  build(begin, middle);
  nodes_[here].first = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

/// Möller and Trumbore 1997.
void TriangleTree::test(std::uint32_t at, const Ray& ray, double& end,
                        std::optional<TriangleHit>& hit) const {
  constexpr double kEdge = 1e-9;  // neighbours overlap by so much, so that no ray slips through
  const auto& [p, q, r] = triangles_[at];
  const Vec3 u = q - p, v = r - p, across = cross(ray.direction, v);
  const double volume = dot(u, across);
  if (volume == 0) return;
  const Vec3 from = ray.origin - p, other = cross(from, u);
  const double b = dot(from, across) / volume, c = dot(ray.direction, other) / volume;
  if (b < -kEdge || c < -kEdge || b + c > 1 + kEdge) return;
  const double t = dot(v, other) / volume;
  if (t <= 0 || t >= end) return;
  end = t;
  hit = TriangleHit{t, at, b, c};
}

std::optional<TriangleHit> TriangleTree::nearest(const Ray& ray) const {
  std::optional<TriangleHit> hit;
  if (nodes_.empty()) return hit;
  const Vec3 inverse{1 / ray.direction[0], 1 / ray.direction[1], 1 / ray.direction[2]};
  double end = kNowhere;
  struct Entry {
    std::uint32_t node;
    double enter;
  };
  const auto entry = [&](std::uint32_t at) {
    return Entry{at, enters(nodes_[at].low, nodes_[at].high, ray, inverse, end)};
  };
  std::array<Entry, 64> stack;  // halves of 2^32 triangles, and room
  std::size_t depth = 0;
  stack[depth++] = entry(0);
  while (depth > 0) {
    const auto [at, enter] = stack[--depth];
    if (enter >= end) continue;  // nowhere is never before
    const Node& node = nodes_[at];
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      test(order_[i], ray, end, hit);
    if (node.count > 0) continue;
    Entry near = entry(at + 1), far = entry(node.first);
    if (far.enter < near.enter) std::swap(near, far);
    if (far.enter < end) stack[depth++] = far;
    if (near.enter < end) stack[depth++] = near;
  }
  return hit;
}

}  // namespace slf::synth
