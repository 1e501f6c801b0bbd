// SPDX-License-Identifier: Apache-2.0
// The environment that explains best what the cameras saw of a surface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "encoder/fit/camera_folds.h"
#include "encoder/fit/environment.h"
#include "encoder/fit/pointwise_observations.h"
#include "slf/fit.h"

namespace slf {

inline constexpr std::size_t kMostLightViews = 200000;

/// Points as mirrors: where they are in the object's box, and their normals of either sign.
struct MirrorPoints {
  std::vector<Vec3> position;
  std::vector<std::array<float, 3>> normal;

  /// Those that directions are mirrored at; none of the world's.
  std::span<const std::array<float, 3>> normals(Directions directions) const {
    return directions == Directions::kReflected ? std::span(normal)
                                                : std::span<const std::array<float, 3>>{};
  }
};
/// @param known  light in another box than that of these positions, or none
MirrorPoints mirror_points(std::span<const Voxel> positions, int cell_log2, int threads,
                           const KnownLight& known = {});

/// What was seen of some of the points, and where a mirror there would look.
struct ReflectedViews {
  std::vector<std::size_t> first;  ///< [points + 1]
  std::vector<Vec3> position;      ///< [points] in the object's box
  std::vector<Vec3> reflected;     ///< [views]
  std::vector<std::array<float, 3>> colour;
  std::vector<std::uint16_t> camera;
};

/// Every n-th point that was seen, n the least with at most `most` views in all (or one point).
ReflectedViews reflected_views(const PointwiseObservations& observations,
                               const MirrorPoints& points, Directions directions, std::size_t most);

/// Light that minimises the squared error of colours less their means over each point, with a
/// penalty of settings.strength * 0.8 * 1.3^degree per view. [(degree + 1)^2][3].
std::vector<float> solve_environment(const ReflectedViews& views, double radius,
                                     const EnvironmentSettings& settings, int threads);

/// The settings with a radius where they have none: that of the least error on held-out cameras. Of
/// degree 0 where there are fewer than three cameras, or no radius explains 2 % of the variance.
/// @param observations  of the directions of settings.directions, as for all here
/// @param folds         camera_folds(observations, points.normals(settings.directions))
EnvironmentSettings with_radius(const PointwiseObservations& observations,
                                const MirrorPoints& points, const FitSettings& settings,
                                const CameraFolds& folds);

/// Nothing where with_radius gives degree 0. From some `most_views` of the observations.
/// The same for any number of threads. O(most_views K^2), K = (degree + 1)^2.
std::optional<Environment> fit_environment(const PointwiseObservations& observations,
                                           const MirrorPoints& points, const FitSettings& settings,
                                           std::size_t most_views = kMostLightViews);

/// The light of fit_environment for fits that see a part of this scene each. None where degree is 0
/// or nothing was seen.
/// @param observations  of local directions
/// @param settings      with a radius
KnownLight known_light(const PointwiseObservations& observations, std::span<const Voxel> positions,
                       const FitSettings& settings);

}  // namespace slf
