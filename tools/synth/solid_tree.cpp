// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/solid_tree.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace slf::synth {
namespace {

constexpr std::uint32_t kLeaf = 3;    // solids, at most
constexpr std::size_t kDeepest = 64;  // halves of 2^32 solids, twice over
constexpr float kEnd = std::numeric_limits<float>::infinity();

/// Does the ray meet the box before `end`, and where?
template <class Node>
bool meets(const Node& node, const Probe& probe, double end, double& enter) {
  enter = 0;
  double leave = end;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (double{node.low[k]} - probe.origin[k]) * probe.inverse[k];
    const double b = (double{node.high[k]} - probe.origin[k]) * probe.inverse[k];
    // In this order a NaN, of a ray within a face, leaves the bounds as they were.
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return enter <= leave;
}

}  // namespace

SolidTree::SolidTree(std::vector<Solid> solids) : solids_(std::move(solids)) {
  nodes_.reserve(solids_.size());
  build(0, static_cast<std::uint32_t>(solids_.size()));
  for (std::size_t k = 0; k < 3; ++k) {
    low_[k] = double{nodes_[0].low[k]};
    high_[k] = double{nodes_[0].high[k]};
  }
}

SolidTree::Node SolidTree::node_of(std::uint32_t begin, std::uint32_t end) const {
  Node node{{kEnd, kEnd, kEnd}, {-kEnd, -kEnd, -kEnd}, begin, end - begin};
  for (std::uint32_t i = begin; i < end; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const auto low = std::nextafter(static_cast<float>(solids_[i].low[k]), -kEnd);
      const auto high = std::nextafter(static_cast<float>(solids_[i].high[k]), kEnd);
      node.low[k] = std::min(node.low[k], low);
      node.high[k] = std::max(node.high[k], high);
    }
  return node;
}

void SolidTree::build(std::uint32_t begin, std::uint32_t end) {
  const std::size_t here = nodes_.size();
  nodes_.push_back(node_of(begin, end));
  if (end - begin <= kLeaf) return;
  std::size_t axis = 0;
  const auto centre = [&axis](const Solid& s) { return s.low[axis] + s.high[axis]; };
  double widest = -1;
  for (std::size_t k = 0; k < 3; ++k) {
    const auto on = [k](const Solid& a, const Solid& b) {
      return a.low[k] + a.high[k] < b.low[k] + b.high[k];
    };
    const auto [least, most] =
        std::minmax_element(solids_.begin() + begin, solids_.begin() + end, on);
    const double width = most->low[k] + most->high[k] - least->low[k] - least->high[k];
    if (width > widest) {
      widest = width;
      axis = k;
    }
  }
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(solids_.begin() + begin, solids_.begin() + middle, solids_.begin() + end,
                   [&](const Solid& a, const Solid& b) { return centre(a) < centre(b); });
  nodes_[here].count = 0;
  build(begin, middle);
  nodes_[here].first = static_cast<std::uint32_t>(nodes_.size());
  build(middle, end);
}

/// Visits the solids whose boxes the ray meets before `end`, near ones first; `end` may shrink, and
/// the walk is over once it is negative.
template <class Visit>
void SolidTree::walk(const Probe& probe, const double& end, Visit&& visit) const {
  struct Entry {
    std::uint32_t node;
    double enter;
  };
  std::array<Entry, kDeepest> stack;
  std::size_t depth = 0;
  double enter = 0;
  if (!meets(nodes_[0], probe, end, enter)) return;
  stack[depth++] = {0, enter};
  while (depth > 0) {
    const Entry entry = stack[--depth];
    if (entry.enter > end) continue;
    const Node& node = nodes_[entry.node];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) visit(solids_[i]);
      continue;
    }
    Entry near{entry.node + 1, 0}, far{node.first, 0};
    const bool first = meets(nodes_[near.node], probe, end, near.enter);
    const bool second = meets(nodes_[far.node], probe, end, far.enter);
    if (near.enter > far.enter && first && second) std::swap(near, far);
    if (first && second) stack[depth++] = far;
    if (first || second) stack[depth++] = first && second ? near : first ? near : far;
  }
}

std::optional<Hit> SolidTree::nearest(const Ray& ray) const {
  const Probe probe(ray);
  double end = std::numeric_limits<double>::infinity();
  Hit hit{0, {}, nullptr};
  walk(probe, end, [&](const Solid& solid) {
    const auto c = chord(solid, probe);
    if (!c || c->enter <= 0 || c->enter >= end) return;
    end = c->enter;
    hit = {end, {ray.at(end), c->enter_normal}, &solid};
  });
  if (hit.solid == nullptr) return std::nullopt;
  return hit;
}

bool SolidTree::blocked(const Ray& ray) const {
  const Probe probe(ray);
  double end = std::numeric_limits<double>::infinity();
  walk(probe, end, [&](const Solid& solid) {
    if (end < 0) return;
    const auto c = chord(solid, probe);
    if (c && c->enter > 0) end = -1;
  });
  return end < 0;
}

bool SolidTree::inside(const Vec3& point) const {
  std::array<std::uint32_t, kDeepest> stack;
  std::size_t depth = 0;
  stack[depth++] = 0;
  while (depth > 0) {
    const std::uint32_t at = stack[--depth];
    const Node& node = nodes_[at];
    bool out = false;
    for (std::size_t k = 0; k < 3; ++k)
      out |= point[k] < double{node.low[k]} || point[k] > double{node.high[k]};
    if (out) continue;
    if (node.count == 0) {
      stack[depth++] = node.first;
      stack[depth++] = at + 1;
      continue;
    }
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
      if (contains(solids_[i], point)) return true;
  }
  return false;
}

}  // namespace slf::synth
