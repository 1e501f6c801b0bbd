#include "scene/depth_maps.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "base/hexadecimal.h"
#include "base/sha256.h"
#include "base/vec3.h"
#include "scene/work_directory.h"

namespace slf {
namespace {

/// Of what distortion may add to a field of view, in tangents.
constexpr double kDistorted = 1.3;

Vec3 in_camera(const Camera& camera, const Vec3& at) {
  Vec3 seen = camera.translation;
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t c = 0; c < 3; ++c) seen[r] += camera.rotation[r][c] * at[c];
  return seen;
}

}  // namespace

Result<DepthMaps, InputError> DepthMaps::in(const std::filesystem::path& work,
                                            const Capture& capture, const SceneCells& scene,
                                            const ScenePlan& plan,
                                            const EncoderSettings& settings) {
  const DepthSettings depth{settings.observe.occlusion_resolution, plan.spacing,
                            settings.observe.depth_tolerance};
  Sha256 sha;
  const auto add = [&](const auto& value) {
    sha.update({reinterpret_cast<const std::uint8_t*>(&value), sizeof value});
  };
  sha.update({reinterpret_cast<const std::uint8_t*>(plan.points_digest.data()),
              plan.points_digest.size()});
  for (const double x : {depth.resolution, depth.spacing, depth.tolerance}) add(x);
  for (const Camera& camera : capture.cameras) {
    for (const double x :
         {double(camera.width), double(camera.height), camera.fx, camera.fy, camera.cx, camera.cy})
      add(x);
    add(camera.distortion);
    add(camera.rotation);
    add(camera.translation);
  }
  auto directory = work / ("depth-" + hexadecimal(sha.finish()).substr(0, 16));
  SLF_CHECK(make_directory(directory));
  return DepthMaps(capture, scene, depth, std::move(directory));
}

bool may_see(const Camera& camera, const Vec3& middle, double radius) {
  const Vec3 at = in_camera(camera, middle);
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

Result<DepthBuffer, InputError> DepthMaps::make(const Camera& camera) const {
  DepthBuffer buffer(camera, settings_);
  const double radius = scene_.radius();
  for (std::size_t cell = 0; cell < scene_.count(); ++cell) {
    if (!may_see(camera, scene_.middle(cell), radius)) continue;
    SLF_TRY(const auto codes,
            scene_.store.codes(scene_.first[cell], scene_.first[cell + 1] - scene_.first[cell]));
    buffer.add(camera, positions_of(scene_, codes));
  }
  return buffer;
}

Result<DepthBuffer, InputError> DepthMaps::of(int index) const {
  const Camera& camera = capture_.cameras[static_cast<std::size_t>(index)];
  const std::filesystem::path file = directory_ / std::to_string(index);
  DepthBuffer buffer(camera, settings_);
  const std::size_t bytes = buffer.depths().size_bytes();
  if (const auto kept = read_file(file, bytes); kept && kept->size() == bytes) {
    std::memcpy(buffer.depths().data(), kept->data(), bytes);
    return buffer;
  }
  SLF_TRY(buffer, make(camera));
  SLF_CHECK(write_file(file, buffer.depths().data(), bytes));
  return buffer;
}

}  // namespace slf
