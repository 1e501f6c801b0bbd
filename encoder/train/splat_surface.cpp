// SPDX-License-Identifier: Apache-2.0
#include "slf/splat_surface.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/vec3.h"
#include "encoder/measure/outlines.h"
#include "encoder/train/tile_pixels.h"
#include "encoder/train/train_gaussians.h"
#include "encoder/train/train_geometry.h"
#include "encoder/train/training_start.h"

namespace slf {
namespace {

using Quaternion = std::array<float, 4>;  // w, x, y, z

Quaternion product(const Quaternion& a, const Quaternion& b) {
  return {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
          a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
          a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
          a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]};
}

/// Its third axis, the normal, is the shortest: axes change places in turn, x for y for z.
TrainedSurfel surfel_of(const Gaussians& splats, std::size_t p, const Vec3& origin) {
  constexpr std::array<Quaternion, 3> kTurns = {
      {{0.5f, 0.5f, 0.5f, 0.5f}, {0.5f, -0.5f, -0.5f, -0.5f}, {1, 0, 0, 0}}};
  const auto& d = splats.log_deviations[p];
  const std::size_t shortest = std::size_t(std::min_element(d.begin(), d.end()) - d.begin());
  const Quaternion turn = product(splats.rotations[p], kTurns[shortest]);
  const float reach = std::log(kGaussianReach) / 2;
  TrainedSurfel surfel;
  for (std::size_t a = 0; a < 3; ++a) {
    surfel.value[TrainedSurfel::kPosition + a] = float(double(splats.positions[p][a]) - origin[a]);
    surfel.value[TrainedSurfel::kLogRadius + a] = d[(shortest + 1 + a) % 3] + reach;
  }
  for (std::size_t i = 0; i < 4; ++i) surfel.value[TrainedSurfel::kTurn + i] = turn[i];
  surfel.value[TrainedSurfel::kOpacity] = splats.logits[p];
  return surfel;
}

}  // namespace

Result<PointCloud, InputError> surface_of_splats(const Gaussians& splats, const Capture& capture,
                                                 std::span<const int> cameras, int threads) {
  SLF_CHECK(check_gaussians(splats));
  return surface_of_splats_from(minus(capture.origin, splats.origin), splats, capture, cameras,
                                threads);
}

Result<PointCloud, InputError> surface_of_splats_from(const Vec3& origin, const Gaussians& splats,
                                                      const Capture& capture,
                                                      std::span<const int> cameras, int threads) {
  TrainedSurfels surfels(splats.size());
  Capture looked_at = capture;
  looked_at.mesh = {};
  looked_at.cloud = {};
  for (std::size_t p = 0; p < surfels.size(); ++p) {
    surfels[p] = surfel_of(splats, p, origin);
    looked_at.cloud.positions.push_back(surfels[p].position());
  }
  const auto refuse = [](const std::string& why) {
    return InputError{Errc::kInvalidInput, "splats become points by cameras that see them: " + why};
  };
  if (const std::string why = training_obstacle(looked_at, cameras); !why.empty())
    return refuse(why);
  SLF_TRY(const std::vector<Outline> outlines, outlines_of(looked_at, cameras, threads));
  if (are_outlined(outlines.size(), cameras.size())) keep_object(outlines, threads, surfels);
  TrainGeometrySettings settings;
  settings.threads = threads;
  SLF_TRY(TrainingStart start, training_start(looked_at, cameras, settings, {}));
  for (TrainingView& view : start.views) view.camera.gaussian = true;
  TrainedGeometry shown;
  if (!start.views.empty())
    shown = geometry_of(std::move(surfels), looked_at, cameras, start.views, settings);
  if (shown.cloud.positions.empty()) return refuse("they show no surface");
  return std::move(shown.cloud);
}

}  // namespace slf
