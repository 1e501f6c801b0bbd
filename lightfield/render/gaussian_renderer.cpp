// SPDX-License-Identifier: Apache-2.0
#include "slf/gaussian_renderer.h"

#include "lightfield/render/empty_rendering.h"
#include "lightfield/render/gaussian_cloud.h"
#include "lightfield/render/gaussian_tiles.h"
#include "lightfield/render/orbit_camera.h"
#include "lightfield/render/render_splats.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kTilesPerRange = 4;

}  // namespace

GaussianRenderer::GaussianRenderer(const Gaussians& gaussians, const RenderSettings& settings)
    : gaussians_(gaussians),
      settings_(settings),
      cloud_(std::make_shared<const GaussianCloud>(gaussian_cloud(gaussians, settings.threads))) {}

Rendering GaussianRenderer::render(const Camera& camera, const std::atomic<bool>* ended) const {
  const Vec3& from = gaussians_.origin;
  const Camera local = moved(camera, {-from[0], -from[1], -from[2]});
  const auto splats =
      project_gaussians(gaussians_, *cloud_, local, settings_.view_dependent, settings_.threads);
  const GaussianTiles tiles = bin_gaussians(splats, camera.width, camera.height, settings_.threads);
  Rendering out = empty_rendering(camera, ended);
  parallel_ranges(tiles.size(), kTilesPerRange, settings_.threads,
                  [&](std::size_t begin, std::size_t end) {
                    for (std::size_t i = begin; i < end && !is_ended(ended); ++i)
                      blend_tile(splats, tiles, i, settings_.background, out);
                  });
  return out;
}

Camera GaussianRenderer::orbit(double turn, double elevation_degrees, int width, int height,
                               double fov_degrees) const {
  return moved(orbit_camera(cloud_->ball, gaussians_.up,
                            {turn, elevation_degrees, width, height, fov_degrees}),
               gaussians_.origin);
}

}  // namespace slf
