// SPDX-License-Identifier: Apache-2.0
// Normals of a cloud by principal component analysis of each point's neighbourhood.
#include <algorithm>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "capture/nearest.h"
#include "capture/normal_orientation.h"
#include "slf/capture.h"
#include "slf/parallel.h"

namespace slf {

namespace {

// The direction of least spread, of either sign.
std::array<float, 3> direction_of_least_spread(const PointCloud& cloud,
                                               const std::uint32_t* indices, int k) {
  // Relative to the first point: differences keep what coordinates far from the origin would lose.
  const auto& origin = cloud.positions[indices[0]];
  const auto offset = [&](int i) {
    const auto& p = cloud.positions[indices[i]];
    return Eigen::Vector3d(double{p[0]} - double{origin[0]}, double{p[1]} - double{origin[1]},
                           double{p[2]} - double{origin[2]});
  };
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (int i = 0; i < k; ++i) mean += offset(i);
  mean /= k;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  for (int i = 0; i < k; ++i) {
    const Eigen::Vector3d d = offset(i) - mean;
    covariance += d * d.transpose();
  }
  // Eigenvalues ascending.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const Eigen::Vector3d normal = solver.eigenvectors().col(0).normalized();
  return {static_cast<float>(normal[0]), static_cast<float>(normal[1]),
          static_cast<float>(normal[2])};
}

}  // namespace

std::vector<std::array<float, 3>> estimate_normals(const PointCloud& cloud,
                                                   const std::vector<Vec3>& viewpoints, int k,
                                                   int threads) {
  const std::size_t count = cloud.positions.size();
  std::vector<std::array<float, 3>> normals(count);
  if (count == 0) return normals;
  // At most 256: beyond, a neighbourhood is no plane any more.
  const auto near = std::clamp<std::size_t>(static_cast<std::size_t>(std::max(k, 1)), 1,
                                            std::min<std::size_t>(count, 256));
  const NearestPoints tree(cloud.positions);
  std::vector<std::uint32_t> neighbours(count * near);
  parallel_ranges(count, 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearest(cloud.positions[i], static_cast<int>(near), &neighbours[i * near], nullptr);
      normals[i] = direction_of_least_spread(cloud, &neighbours[i * near], static_cast<int>(near));
    }
  });
  if (viewpoints.empty())
    orient_outwards(cloud.positions, normals);
  else
    orient_towards(cloud.positions, viewpoints, neighbours, threads, normals);
  return normals;
}

}  // namespace slf
