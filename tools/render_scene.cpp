// SPDX-License-Identifier: Apache-2.0
#include "tools/render_scene.h"

#include <limits>

namespace slf::tools {
namespace {

/// Splats have radii of their own.
Outcome check_radius(const RenderSettings& settings, const std::string& file) {
  if (!(settings.radius > 0)) return Done{};
  return Failure{kUsage, "render: --radius is for surfaces, and " + file + " holds splats"};
}

}  // namespace

Result<std::unique_ptr<RenderScene>, Failure> RenderScene::load(const std::string& file,
                                                                const RenderSettings& settings,
                                                                const PartOptions& part,
                                                                const LimitOptions& limits,
                                                                const CommonOptions& common) {
  auto scene = std::make_unique<RenderScene>();
  Stopwatch watch;
  if (is_splat_file(file)) {
    SLF_CHECK(check_radius(settings, file));
    SLF_TRY(scene->file_, read_splat_file("render", file, part, limits, common));
    watch.lap();
    scene->splats_ = std::make_unique<GaussianRenderer>(scene->file_.gaussians, settings);
  } else {
    SLF_TRY(DecodedFile decoded, decode_file(file, part, limits, common));
    SLF_CHECK(require_view_maps(decoded.field, file));
    const bool empty = decoded.field.num_points() == 0;
    if (empty && decoded.field.partial && part.frame < 0)
      return Failure{kInputInvalid,
                     input_name(file) + ": has no points, or none in what was asked for"};
    scene->field_ = std::move(decoded.field);
    scene->metadata_ = std::move(decoded.metadata);
    scene->background_ = settings.background;
    if (empty) return scene;
    watch.lap();
    if (has_gaussians(scene->field_.header)) {
      SLF_CHECK(check_radius(settings, input_name(file)));
      SLF_TRY(scene->file_.gaussians,
              from(input_name(file), gaussians_of(scene->field_, common.threads)));
      scene->splats_ = std::make_unique<GaussianRenderer>(scene->file_.gaussians, settings);
      scene->prepare_ = watch.lap();
      return scene;
    }
    scene->maps_ = std::make_unique<ViewMaps>(scene->field_, common.threads);
    scene->points_ = std::make_unique<Renderer>(*scene->maps_, settings);
  }
  scene->prepare_ = watch.lap();
  return scene;
}

Rendering RenderScene::render(const Camera& camera) const {
  if (points_) return points_->render(camera);
  if (splats_) return splats_->render(camera);
  const std::size_t pixels =
      static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height);
  Rendering nothing;
  nothing.image.width = camera.width;
  nothing.image.height = camera.height;
  nothing.image.channels = 3;
  for (std::size_t i = 0; i < pixels; ++i)
    nothing.image.data.insert(nothing.image.data.end(), background_.begin(), background_.end());
  nothing.coverage.assign(pixels, 0);
  nothing.depth.assign(pixels, std::numeric_limits<float>::infinity());
  return nothing;
}

Camera RenderScene::orbit(double turn, double elevation_degrees, int width, int height,
                          double fov_degrees) const {
  if (points_) return points_->orbit(turn, elevation_degrees, width, height, fov_degrees);
  if (splats_) return splats_->orbit(turn, elevation_degrees, width, height, fov_degrees);
  Camera nowhere;
  nowhere.width = width;
  nowhere.height = height;
  return nowhere;
}

Image transparent(const Rendering& rendering) {
  Image out = rendering.image;
  out.channels = 4;
  out.data.clear();
  for (std::size_t i = 0; i < rendering.coverage.size(); ++i) {
    const unsigned alpha = rendering.coverage[i];
    for (std::size_t c = 0; c < 3; ++c) {
      const unsigned value = rendering.image.data[3 * i + c];
      out.data.push_back(static_cast<std::uint8_t>(
          alpha == 0 ? 0 : std::min(255u, (value * 255 + alpha / 2) / alpha)));
    }
    out.data.push_back(static_cast<std::uint8_t>(alpha));
  }
  return out;
}

}  // namespace slf::tools
