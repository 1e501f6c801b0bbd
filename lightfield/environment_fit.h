// The environment that explains best what the cameras saw of a surface.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "lightfield/environment.h"
#include "slf/fit.h"

namespace slf {

/// What was seen of some of the points, and where a mirror there would look.
struct ReflectedViews {
  std::vector<std::size_t> first;  ///< [points + 1]
  std::vector<Vec3> position;      ///< [points] in the object's box
  std::vector<Vec3> reflected;     ///< [views]
  std::vector<std::array<float, 3>> colour;
  std::vector<std::uint16_t> camera;
};

/// Every n-th point that was seen, n the least with at most `most` views in all (or one point).
/// @param observations  of the directions of `frame`
/// @param normals       [P] of the reflected frame
ReflectedViews reflected_views(const Observations& observations, std::span<const Voxel> positions,
                               std::span<const std::array<float, 3>> normals, FrameId frame,
                               std::size_t most);

/// [cameras] of 0 .. 3: parts of the cameras to hold out in turn. Cameras close to each other, as
/// seen from the object, are in the same part; so what is held out has no neighbour left.
std::vector<int> camera_folds(std::span<const Vec3> towards_camera);

/// Light that minimises the squared error of colours less their means over each point, with a
/// penalty of settings.strength * 0.8 * 1.3^degree per view. [(degree + 1)^2][3].
std::vector<float> solve_environment(const ReflectedViews& views, double radius,
                                     const EnvironmentSettings& settings, int threads);

/// The radius with the least error on held-out cameras, or none: fewer than three cameras, or no
/// radius that explains 2 % of the variance.
std::optional<double> choose_radius(const ReflectedViews& views, std::span<const int> fold,
                                    const EnvironmentSettings& settings, int threads);

/// Nothing where settings.environment.degree is 0, or choose_radius finds none.
/// The same for any number of threads. O(min(views, 200,000) K^2), K = (degree + 1)^2.
std::optional<Environment> fit_environment(const Observations& observations,
                                           std::span<const Voxel> positions,
                                           std::span<const std::array<float, 3>> normals,
                                           const FitSettings& settings);

}  // namespace slf
