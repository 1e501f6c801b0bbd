// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/camera_folds.h"

#include <algorithm>
#include <cmath>

#include "lightfield/directions.h"

namespace slf {
namespace {

constexpr int kFolds = 4;

}  // namespace

std::vector<int> camera_folds(std::span<const Vec3> towards_camera, std::size_t groups) {
  const std::size_t cameras = towards_camera.size();
  const std::size_t least = std::clamp<std::size_t>(cameras / 2, std::size_t{kFolds}, groups);
  const std::size_t clusters = std::min(cameras, std::clamp<std::size_t>(cameras / 5, least, 32));
  const auto cosine = [&](std::size_t a, std::size_t b) {
    const Vec3 &x = towards_camera[a], &y = towards_camera[b];
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
  };
  // Seeds as far from each other as they can be, one after the other; then the nearest seed.
  std::vector<int> cluster(cameras, 0);
  std::vector<double> nearest(cameras, -2);
  std::size_t seed = 0;
  for (std::size_t k = 0; k < clusters; ++k) {
    for (std::size_t i = 0; i < cameras; ++i)
      if (cosine(i, seed) > nearest[i]) {
        nearest[i] = cosine(i, seed);
        cluster[i] = static_cast<int>(k) % kFolds;
      }
    seed = static_cast<std::size_t>(std::min_element(nearest.begin(), nearest.end()) -
                                    nearest.begin());
  }
  return cluster;
}

CameraFolds camera_folds(const PointwiseObservations& observations,
                         std::span<const std::array<float, 3>> normals) {
  std::vector<Vec3> towards;  // sums
  SeenRoom room;
  for (std::size_t p = 0; p < observations.points(); ++p) {
    const SeenPoint seen = observations.of(p, room);
    for (std::size_t j = 0; j < seen.count(); ++j) {
      const std::size_t camera = seen.camera[j];
      if (camera >= towards.size()) towards.resize(camera + 1, Vec3{});
      const Vec3 w = vector_of(to_local(normals, p, seen.direction[j]));
      for (std::size_t a = 0; a < 3; ++a) towards[camera][a] += w[a];
    }
  }
  CameraFolds folds;
  folds.of_camera.assign(towards.size(), -1);
  std::vector<std::size_t> seen;
  std::vector<Vec3> directions;
  for (std::size_t camera = 0; camera < towards.size(); ++camera) {
    const Vec3& sum = towards[camera];
    const double length = std::sqrt(sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]);
    if (length == 0) continue;
    seen.push_back(camera);
    directions.push_back({sum[0] / length, sum[1] / length, sum[2] / length});
  }
  const std::vector<int> fold = camera_folds(directions);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    folds.of_camera[seen[i]] = fold[i];
    folds.count = std::max(folds.count, fold[i] + 1);
  }
  folds.cameras = seen.size();
  return folds;
}

}  // namespace slf
