// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/depth_maps.h"

#include <cstring>

#include "base/hexadecimal.h"
#include "base/sha256.h"
#include "encoder/parts/scene_cameras.h"
#include "encoder/parts/work_directory.h"

namespace slf {

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
