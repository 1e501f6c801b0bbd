// SPDX-License-Identifier: Apache-2.0
#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "capture/quantile.h"
#include "encoder/train/starting_points.h"

namespace slf {
namespace {

constexpr double kLeastSpread = 0.01;  // of the axes: 1 / 3 where they come from everywhere
constexpr double kLeastInFront = 0.8;  // of the cameras
constexpr int kRounds = 3;             // axes that pass far away are left out after the first
constexpr double kFar = 3;             // times the median distance

Eigen::Vector3d centre_of(const Camera& camera) {
  const Vec3 c = camera.centre();
  return {c[0], c[1], c[2]};
}

Eigen::Vector3d axis_of(const Camera& camera) {
  return Eigen::Vector3d(camera.rotation[2][0], camera.rotation[2][1], camera.rotation[2][2]);
}

double distance_to_axis(const Camera& camera, const Eigen::Vector3d& point) {
  return axis_of(camera).cross(point - centre_of(camera)).norm();
}

InputError apart() {
  return {Errc::kInvalidInput,
          "the capture has no points, and its cameras do not look at one place: give points, as of "
          "COLMAP (--points)"};
}

/// The point whose squared distances from the axes are the least; false: they say nothing of it.
bool nearest_to_axes(const std::vector<const Camera*>& cameras, Eigen::Vector3d& point) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const Camera* camera : cameras) {
    const Eigen::Vector3d axis = axis_of(*camera);
    const Eigen::Matrix3d across = Eigen::Matrix3d::Identity() - axis * axis.transpose();
    sum += across;
    right += across * centre_of(*camera);
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
  if (!(solver.eigenvalues()[0] > kLeastSpread * double(cameras.size()))) return false;
  point = sum.ldlt().solve(right);
  return point.allFinite();
}

}  // namespace

Result<LookedAt, InputError> looked_at(const Capture& capture, std::span<const int> cameras) {
  std::vector<const Camera*> used;
  for (const int c : cameras) used.push_back(&capture.cameras[std::size_t(c)]);
  Eigen::Vector3d point;
  for (int round = 0; round < kRounds; ++round) {
    if (used.size() < 3 || !nearest_to_axes(used, point)) return apart();
    std::vector<double> distances;
    for (const Camera* camera : used) distances.push_back(distance_to_axis(*camera, point));
    const double limit = kFar * median(std::vector<double>(distances));
    std::size_t kept = 0;
    for (std::size_t i = 0; i < used.size(); ++i)
      if (distances[i] <= limit) used[kept++] = used[i];
    used.resize(kept);
  }
  std::vector<double> radii;
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[std::size_t(c)];
    const double depth = axis_of(camera).dot(point - centre_of(camera));
    const double half = std::min(camera.width / camera.fx, camera.height / camera.fy) / 2;
    if (depth > 0) radii.push_back(depth * half / std::hypot(1, half));
  }
  if (double(radii.size()) < kLeastInFront * double(cameras.size())) return apart();
  return LookedAt{{point[0], point[1], point[2]}, median(std::move(radii))};
}

}  // namespace slf
