// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/scene_cameras.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <system_error>

#include "base/hexadecimal.h"
#include "base/sha256.h"
#include "base/vec3.h"
#include "capture/image_cache.h"
#include "capture/photograph_size.h"

namespace slf {
namespace {

/// The most that distortion may add to a field of view, in tangents.
constexpr double kDistorted = 1.3;

}  // namespace

bool may_see(const Camera& camera, const Vec3& middle, double radius) {
  const Vec3 at = camera.in_camera(middle);
  if (at[2] < -radius) return false;
  const bool distorted = camera.distortion != std::array<double, 4>{};
  const double wider = distorted ? kDistorted : 1;
  const std::array<double, 2> low = {-camera.cx / camera.fx, -camera.cy / camera.fy};
  const std::array<double, 2> high = {(camera.width - camera.cx) / camera.fx,
                                      (camera.height - camera.cy) / camera.fy};
  for (std::size_t k = 0; k < 2; ++k) {  // the distance to each side of the pyramid
    const double l = wider * low[k], h = wider * high[k];
    if ((l * at[2] - at[k]) / std::hypot(l, 1) > radius) return false;
    if ((at[k] - h * at[2]) / std::hypot(h, 1) > radius) return false;
  }
  return true;
}

std::vector<int> cameras_of(const Capture& capture, std::span<const int> cameras,
                            const SceneCells& scene, std::span<const std::size_t> cells) {
  std::vector<int> seeing;
  const double radius = scene.radius();
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(c)];
    if (std::any_of(cells.begin(), cells.end(),
                    [&](std::size_t cell) { return may_see(camera, scene.middle(cell), radius); }))
      seeing.push_back(c);
  }
  return seeing;
}

std::vector<int> choose_reduction(const Capture& capture, std::span<const int> cameras,
                                  const SceneCells& scene, double spacing) {
  std::vector<int> reduction(capture.cameras.size(), 0);
  const double radius = scene.radius();
  for (const int c : cameras) {
    const Camera& camera = capture.cameras[static_cast<std::size_t>(c)];
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t cell = 0; cell < scene.count(); ++cell) {
      const Vec3 middle = scene.middle(cell);
      if (may_see(camera, middle, radius))
        nearest = std::min(nearest, camera.in_camera(middle)[2] - radius);
    }
    reduction[static_cast<std::size_t>(c)] = least_photograph(camera, nearest, spacing);
  }
  return reduction;
}

Capture scene_cameras(const Capture& capture, const ScenePlan& plan, std::uint64_t cache) {
  Capture cameras;
  cameras.root = capture.root;
  cameras.origin = plan.origin;
  cameras.reduction = plan.reduction;
  const Vec3 by = minus(capture.origin, plan.origin);
  for (std::size_t c = 0; c < capture.cameras.size(); ++c)
    cameras.cameras.push_back(reduced(moved(capture.cameras[c], by), plan.reduction[c]));
  cameras.image_files = capture.image_files;
  cameras.orientation = capture.orientation;
  cameras.images = capture.images;
  cameras.mask_files = capture.mask_files;
  cameras.up = capture.up;
  cameras.cache = std::make_shared<ImageCache>(cache);
  return cameras;
}

std::uint64_t cache_of(const ScenePlan& plan, const SceneWork& work) {
  return (work.memory - std::min(work.memory, cost_of(plan).memory)) / 2;
}

std::string digest_of_photographs(const Capture& capture, const Vec3& origin) {
  Sha256 sha;
  const auto add = [&](const auto& value) {
    sha.update({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  };
  const Vec3 by = minus(capture.origin, origin);
  for (const Camera& own : capture.cameras) {
    const Camera camera = moved(own, by);
    const auto add_float = [&](double x) { add(static_cast<float>(x) + 0.0F); };
    for (const double x :
         {double(camera.width), double(camera.height), camera.fx, camera.fy, camera.cx, camera.cy})
      add_float(x);
    for (const double x : camera.distortion) add_float(x);
    for (const auto& row : camera.rotation)
      for (const double x : row) add_float(x);
    for (const double x : camera.translation) add_float(x);
  }
  for (const std::filesystem::path& file : capture.image_files) {
    std::error_code ignored;
    add(static_cast<std::uint64_t>(std::filesystem::file_size(file, ignored)));
  }
  return hexadecimal(sha.finish());
}

}  // namespace slf
