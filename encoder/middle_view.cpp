// SPDX-License-Identifier: Apache-2.0
#include "encoder/middle_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/shortest.h"
#include "base/vec3.h"

namespace slf {
namespace {

std::string middle_view(const Capture& capture, std::span<const int> cameras,
                        const TrainingCache& cache) {
  const auto camera_of = [&](int index) -> const Camera& {
    return capture.cameras[std::size_t(index)];
  };
  Vec3 middle{0, 0, 0};
  for (const int c : cameras)
    for (std::size_t k = 0; k < 3; ++k)
      middle[k] += camera_of(c).centre()[k] / double(cameras.size());
  const auto from_middle = [&](int index) {
    const Vec3 to = minus(camera_of(index).centre(), middle);
    return dot(to, to);
  };
  const int nearest = *std::min_element(cameras.begin(), cameras.end(), [&](int a, int b) {
    return from_middle(a) < from_middle(b);
  });
  const Camera& camera = camera_of(nearest);
  const auto index = std::size_t(nearest);
  const double depth =
      index < cache.views.size() && cache.views[index] ? double(cache.views[index]->depth) : 1;
  const double half_side = std::min(camera.width / camera.fx, camera.height / camera.fy) / 2;
  const Vec3 eye = moved(camera, capture.origin).centre();
  std::string out;
  for (const double value : eye) out += shortest(value) + " ";
  for (std::size_t k = 0; k < 3; ++k) out += shortest(eye[k] + depth * camera.rotation[2][k]) + " ";
  return out + shortest(std::clamp(2 * std::atan(half_side) * 180 / std::numbers::pi, 1.0, 170.0));
}

}  // namespace

void add_middle_view(const Capture& capture, std::span<const int> cameras,
                     const TrainingCache& cache, const Metadata& named, Metadata& metadata) {
  if (cache.outlined || std::any_of(named.begin(), named.end(),
                                    [](const auto& pair) { return pair.first == "view"; }))
    return;
  metadata.emplace_back("view", middle_view(capture, cameras, cache));
}

}  // namespace slf
