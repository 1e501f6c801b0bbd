// SPDX-License-Identifier: Apache-2.0
// What is nearest to each camera of a scene: made once of all points, kept on disk.
#pragma once

#include <filesystem>
#include <vector>

#include "encoder/fit/observe_depth.h"
#include "encoder/parts/region.h"
#include "slf/capture.h"
#include "slf/scene.h"

namespace slf {

/// Thread-safe; several processes may share the directory.
class DepthMaps {
 public:
  /// In a directory of its own below `work`, which the same points, cameras and settings share.
  /// capture and scene are kept by reference.
  /// @errors kUnwritable
  static Result<DepthMaps, InputError> in(const std::filesystem::path& work, const Capture& capture,
                                          const SceneCells& scene, const ScenePlan& plan,
                                          const EncoderSettings& settings);

  /// @errors kUnreadable, kUnwritable
  Result<DepthBuffer, InputError> of(int camera) const;

 private:
  DepthMaps(const Capture& capture, const SceneCells& scene, const DepthSettings& settings,
            std::filesystem::path directory)
      : capture_(capture), scene_(scene), settings_(settings), directory_(std::move(directory)) {}
  Result<DepthBuffer, InputError> make(const Camera& camera) const;

  const Capture& capture_;
  const SceneCells& scene_;
  DepthSettings settings_;
  std::filesystem::path directory_;
};

}  // namespace slf
