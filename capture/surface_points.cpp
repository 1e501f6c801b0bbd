// SPDX-License-Identifier: Apache-2.0
#include "capture/surface_points.h"

#include <algorithm>
#include <cmath>

#include "capture/nearest.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kGrain = 1024;

using Symmetric = std::array<double, 6>;  // xx, xy, xz, yy, yz, zz

/// The direction of least spread, found from `start` by powers of the inverse of c.
Float3 least_direction(const Symmetric& c, const Float3& start) {
  const double ridge = 1e-4 * (c[0] + c[3] + c[5]);
  if (!(ridge > 0)) return start;
  const double a = c[0] + ridge, b = c[1], d = c[2], e = c[3] + ridge, f = c[4], g = c[5] + ridge;
  const double xx = e * g - f * f, xy = d * f - b * g, xz = b * f - d * e;
  const double yy = a * g - d * d, yz = b * d - a * f, zz = a * e - b * b;
  std::array<double, 3> n{start[0], start[1], start[2]};
  for (int round = 0; round < 6; ++round) {
    const std::array<double, 3> m{xx * n[0] + xy * n[1] + xz * n[2],
                                  xy * n[0] + yy * n[1] + yz * n[2],
                                  xz * n[0] + yz * n[1] + zz * n[2]};
    const double length = std::sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2]);
    if (!(length > 0)) return start;
    for (std::size_t i = 0; i < 3; ++i) n[i] = m[i] / length;
  }
  const Float3 found{float(n[0]), float(n[1]), float(n[2])};
  return dot(found, start) < 0 ? Float3{-found[0], -found[1], -found[2]} : found;
}

}  // namespace

SurfaceNeighbours find_neighbours(const SurfacePoints& points, std::size_t k, double reach,
                                  int threads) {
  const std::size_t count = points.size();
  SurfaceNeighbours found;
  found.k = std::min(k, count - 1);
  found.index.resize(count * found.k);
  found.weight.resize(count * found.k);
  const NearestPoints tree(points.positions);
  const auto scale = static_cast<float>(1 / (2 * reach * reach));
  parallel_ranges(count, kGrain, threads, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> index(found.k + 1);
    std::vector<float> squared(found.k + 1);
    for (std::size_t p = begin; p < end; ++p) {
      tree.nearest(points.positions[p], static_cast<int>(found.k + 1), index.data(),
                   squared.data());
      std::size_t at = p * found.k;
      for (std::size_t i = 0; i <= found.k && at < (p + 1) * found.k; ++i) {
        if (index[i] == p) continue;
        const float facing = std::max(0.0f, dot(points.normals[p], points.normals[index[i]]));
        found.index[at] = index[i];
        found.weight[at++] = facing * std::exp(-squared[i] * scale);
      }
    }
  });
  return found;
}

std::vector<Float3> plane_normals(const SurfacePoints& points, const SurfaceNeighbours& neighbours,
                                  int threads) {
  std::vector<Float3> normals(points.size());
  parallel_ranges(points.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const auto near = neighbours.of(p);
      const auto weights = neighbours.weights_of(p);
      std::array<double, 3> mean{};
      double sum = 1;
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Float3 d = minus(points.positions[near[i]], points.positions[p]);
        for (std::size_t a = 0; a < 3; ++a) mean[a] += double(weights[i]) * double(d[a]);
        sum += double(weights[i]);
      }
      for (double& m : mean) m /= sum;
      Symmetric c{};
      const auto add = [&](const std::array<double, 3>& d, double w) {
        c[0] += w * d[0] * d[0];
        c[1] += w * d[0] * d[1];
        c[2] += w * d[0] * d[2];
        c[3] += w * d[1] * d[1];
        c[4] += w * d[1] * d[2];
        c[5] += w * d[2] * d[2];
      };
      add({-mean[0], -mean[1], -mean[2]}, 1);
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Float3 d = minus(points.positions[near[i]], points.positions[p]);
        add({double(d[0]) - mean[0], double(d[1]) - mean[1], double(d[2]) - mean[2]},
            double(weights[i]));
      }
      normals[p] = least_direction(c, points.normals[p]);
    }
  });
  return normals;
}

std::vector<float> distance_to_neighbours(const SurfacePoints& points,
                                          const SurfaceNeighbours& neighbours, int threads) {
  std::vector<float> distance(points.size(), 0);
  parallel_ranges(points.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p) {
      const auto near = neighbours.of(p);
      const auto weights = neighbours.weights_of(p);
      float sum = 1, heights = 0;
      for (std::size_t i = 0; i < near.size(); ++i) {
        const Float3 d = minus(points.positions[near[i]], points.positions[p]);
        heights +=
            weights[i] * 0.5f * (dot(d, points.normals[p]) + dot(d, points.normals[near[i]]));
        sum += weights[i];
      }
      distance[p] = heights / sum;
    }
  });
  return distance;
}

void move_along_normals(SurfacePoints& points, std::span<const float> offsets) {
  for (std::size_t p = 0; p < points.size(); ++p)
    points.positions[p] = along(points.positions[p], offsets[p], points.normals[p]);
}

}  // namespace slf
