// SPDX-License-Identifier: Apache-2.0
// What `slf render` draws: a light field, or Gaussian splats of another program.
#pragma once

#include <memory>
#include <string>

#include "slf/gaussian_renderer.h"
#include "tools/splat_input.h"

namespace slf::tools {

class RenderScene {
 public:
  /// @errors of reading and decoding; no points, no view maps
  static Result<std::unique_ptr<RenderScene>, Failure> load(const std::string& file,
                                                            const RenderSettings& settings,
                                                            const PartOptions& part,
                                                            const LimitOptions& limits,
                                                            const CommonOptions& common);

  Rendering render(const Camera& camera) const {
    return points_ ? points_->render(camera) : splats_->render(camera);
  }
  /// As Renderer::orbit().
  Camera orbit(double turn, double elevation_degrees, int width, int height,
               double fov_degrees) const {
    return points_ ? points_->orbit(turn, elevation_degrees, width, height, fov_degrees)
                   : splats_->orbit(turn, elevation_degrees, width, height, fov_degrees);
  }
  bool partial() const { return field_.partial; }
  /// Seconds before the first picture, without reading and decoding.
  double prepare() const { return prepare_; }

 private:
  LightField field_;
  GaussianFile file_;
  std::unique_ptr<const ViewMaps> maps_;            // of field_
  std::unique_ptr<const Renderer> points_;          // of maps_; or
  std::unique_ptr<const GaussianRenderer> splats_;  // of file_
  double prepare_ = 0;
};

}  // namespace slf::tools
