// SPDX-License-Identifier: Apache-2.0
#include "capture/resample.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "capture/nearest.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kNodes = 1024;
constexpr int kNeighbours = 16;

using Node = std::array<std::int32_t, 3>;

Node node_of(const Float3& at, const Lattice& lattice) {
  Node node{};
  for (std::size_t a = 0; a < 3; ++a)
    node[a] = static_cast<std::int32_t>(
        std::floor((double(at[a]) - lattice.origin[a]) / lattice.step + 0.5));
  return node;
}

/// How far a node is from the plane of a point.
double off_plane(const SurfacePoints& points, std::size_t p, const Node& node,
                 const Lattice& lattice) {
  double off = 0;
  for (std::size_t a = 0; a < 3; ++a)
    off += double(points.normals[p][a]) *
           (lattice.origin[a] + lattice.step * node[a] - double(points.positions[p][a]));
  return std::abs(off);
}

/// Nodes around points, each once, in a fixed order. Points that share a node are looked at
/// together, as there may be many.
std::vector<Node> candidates(const SurfacePoints& points, const Lattice& lattice,
                             const ResampleSettings& settings) {
  std::vector<std::pair<Node, std::uint32_t>> own(points.size());
  for (std::size_t p = 0; p < own.size(); ++p)
    own[p] = {node_of(points.positions[p], lattice), std::uint32_t(p)};
  std::sort(own.begin(), own.end());
  const double most = settings.off_plane * lattice.step;
  const std::int32_t n = settings.around;
  std::vector<Node> nodes;
  for (std::size_t begin = 0, end = 0; begin < own.size(); begin = end) {
    const Node& at = own[begin].first;
    while (end < own.size() && own[end].first == at) ++end;
    const auto same = std::span(own).subspan(begin, end - begin);
    for (std::int32_t z = -n; z <= n; ++z)
      for (std::int32_t y = -n; y <= n; ++y)
        for (std::int32_t x = -n; x <= n; ++x) {
          const Node node{at[0] + x, at[1] + y, at[2] + z};
          if (std::any_of(same.begin(), same.end(), [&](const auto& point) {
                return off_plane(points, point.second, node, lattice) <= most;
              }))
            nodes.push_back(node);
        }
  }
  std::sort(nodes.begin(), nodes.end());
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  return nodes;
}

struct Surface {
  double distance = 0;  ///< of the query from it, along the normal
  Float3 normal{};
  Float3 centre{};    ///< weighted mean of the points
  float support = 0;  ///< sum of weights
};

/// The mean plane of the points near `query` that face as the nearest does.
Surface surface_at(const SurfacePoints& points, const Float3& query,
                   std::span<const std::uint32_t> near, std::span<const float> squared,
                   double reach) {
  Surface surface;
  const Float3& facing = points.normals[near[0]];
  const auto scale = float(1 / (2 * reach * reach));
  float heights = 0;
  Float3 normal{};
  for (std::size_t i = 0; i < near.size(); ++i) {
    const Float3& n = points.normals[near[i]];
    const float agree = dot(n, facing);
    if (agree <= 0.2f) continue;
    const float w = agree * std::exp(-squared[i] * scale);
    heights += w * dot(minus(query, points.positions[near[i]]), n);
    normal = along(normal, w, n);
    surface.centre = along(surface.centre, w, points.positions[near[i]]);
    surface.support += w;
  }
  if (!(surface.support > 0)) return surface;
  const float length = std::sqrt(dot(normal, normal));
  surface.distance = double(heights / surface.support);
  for (float& x : surface.centre) x /= surface.support;
  surface.normal = {normal[0] / length, normal[1] / length, normal[2] / length};
  return surface;
}

}  // namespace

SurfacePoints resample(const SurfacePoints& points, const Lattice& lattice,
                       const ResampleSettings& settings) {
  const std::vector<Node> nodes = candidates(points, lattice, settings);
  const NearestPoints tree(points.positions);
  const int k = static_cast<int>(std::min<std::size_t>(kNeighbours, points.size()));
  const double reach = settings.reach * lattice.step, support = settings.support * lattice.step,
               rim = settings.rim * lattice.step, off_centre = settings.off_centre * lattice.step;
  std::vector<Float3> position(nodes.size()), normal(nodes.size());
  std::vector<std::uint32_t> source(nodes.size());
  std::vector<std::uint8_t> kept(nodes.size(), 0);
  parallel_ranges(nodes.size(), kNodes, settings.threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> near(static_cast<std::size_t>(k));
    std::vector<float> squared(static_cast<std::size_t>(k));
    for (std::size_t i = begin; i < end; ++i) {
      bool inside = true;
      Float3 query{};
      for (std::size_t a = 0; a < 3; ++a) {
        query[a] = float(lattice.origin[a] + lattice.step * nodes[i][a]);
        inside =
            inside && (lattice.size[a] == 0 || (nodes[i][a] >= 0 && nodes[i][a] < lattice.size[a]));
      }
      if (!inside) continue;
      tree.nearest(query, k, near.data(), squared.data());
      if (double(squared[0]) > support * support) continue;
      const Surface at = surface_at(points, query, near, squared, reach);
      const float steepest =
          std::max({std::abs(at.normal[0]), std::abs(at.normal[1]), std::abs(at.normal[2])});
      // Half open, so that a line that passes midway between two nodes keeps one of them.
      const double half = 0.5 * lattice.step * double(steepest);
      if (!(at.distance > -half && at.distance <= half)) continue;
      const Float3 foot = along(query, -float(at.distance), at.normal);
      // Beyond the rim: no point on all sides.
      const Float3 beside = minus(foot, points.positions[near[0]]), off = minus(foot, at.centre);
      if (double(dot(beside, beside)) > rim * rim ||
          double(dot(off, off)) > off_centre * off_centre)
        continue;
      position[i] = settings.on_lattice ? query : foot;
      normal[i] = at.normal;
      source[i] = points.source[near[0]];
      kept[i] = 1;
    }
  });
  SurfacePoints sampled;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (kept[i] != 0) {
      sampled.positions.push_back(position[i]);
      sampled.normals.push_back(normal[i]);
      sampled.source.push_back(source[i]);
    }
  return sampled;
}

}  // namespace slf
