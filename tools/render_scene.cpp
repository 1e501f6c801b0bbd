// SPDX-License-Identifier: Apache-2.0
#include "tools/render_scene.h"

namespace slf::tools {

Result<std::unique_ptr<RenderScene>, Failure> RenderScene::load(const std::string& file,
                                                                const RenderSettings& settings,
                                                                const PartOptions& part,
                                                                const LimitOptions& limits,
                                                                const CommonOptions& common) {
  auto scene = std::make_unique<RenderScene>();
  Stopwatch watch;
  if (is_splat_file(file)) {
    SLF_TRY(scene->file_, read_splat_file("render", file, part, limits, common));
    watch.lap();
    scene->splats_ = std::make_unique<GaussianRenderer>(scene->file_.gaussians, settings);
  } else {
    SLF_TRY(DecodedFile decoded, decode_file(file, part, limits, common));
    SLF_CHECK(require_view_maps(decoded.field, file));
    if (decoded.field.num_points() == 0)
      return Failure{kInputInvalid,
                     input_name(file) + ": has no points, or none in what was asked for"};
    scene->field_ = std::move(decoded.field);
    watch.lap();
    if (has_gaussians(scene->field_.header)) {
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

}  // namespace slf::tools
