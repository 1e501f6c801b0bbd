// SPDX-License-Identifier: Apache-2.0
// What `slf render` draws: a light field, or Gaussian splats of another program.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "slf/gaussian_renderer.h"
#include "tools/splat_input.h"

namespace slf::tools {

class RenderScene {
 public:
  /// A frame may have no points.
  /// @errors of reading and decoding; no points where a part was asked for, no view maps
  static Result<std::unique_ptr<RenderScene>, Failure> load(const std::string& file,
                                                            const RenderSettings& settings,
                                                            const PartOptions& part,
                                                            const LimitOptions& limits,
                                                            const CommonOptions& common);

  /// The background where there are no points.
  Rendering render(const Camera& camera) const;
  /// As Renderer::orbit(). Without points it looks nowhere.
  Camera orbit(double turn, double elevation_degrees, int width, int height,
               double fov_degrees) const;
  /// The file's own first view, if it has one.
  std::optional<Camera> view(int width, int height) const {
    return named_view(metadata_, field_.header.up, width, height);
  }
  bool is_empty() const { return !points_ && !splats_; }
  bool partial() const { return field_.partial; }
  /// Seconds before the first picture, without reading and decoding.
  double prepare() const { return prepare_; }

 private:
  LightField field_;
  Metadata metadata_;
  GaussianFile file_;
  std::unique_ptr<const ViewMaps> maps_;            // of field_
  std::unique_ptr<const Renderer> points_;          // of maps_; or
  std::unique_ptr<const GaussianRenderer> splats_;  // of file_
  std::array<std::uint8_t, 3> background_{};
  double prepare_ = 0;
};

/// Colours freed of the black that the renderer composed them with, and coverage as alpha.
Image transparent(const Rendering& rendering);

}  // namespace slf::tools
