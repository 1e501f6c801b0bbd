// SPDX-License-Identifier: Apache-2.0
// The parts of choose_density that meshes need too.
#pragma once

#include <cstddef>
#include <span>

#include "slf/capture.h"

namespace slf {

/// Voxel edge of an automatic grid, in pixels of the sharpest view (docs/decisions/021).
inline constexpr double kPixelsPerVoxel = 1;

/// What an automatic grid takes at the most: memory and time of an encode grow with it.
inline constexpr std::size_t kMostAutomaticPoints = std::size_t{1} << 20;

/// Density::pixel of points that stand for the surface.
/// @param normals  [points] or empty: cameras that do not face a point do not count for it
double pixel_on_surface(const Capture& capture, std::span<const int> cameras,
                        std::span<const std::array<float, 3>> points,
                        std::span<const std::array<float, 3>> normals);

/// A warning where points of a cloud that was to keep all of them were merged; or empty.
/// @param points  of the cloud
std::string merged_warning(const VoxelCloud& cloud, std::size_t points);

/// One line for the person who wonders at an automatic grid that is coarser than the photographs;
/// empty where there is nothing to say.
std::string density_warning(const Density& density);

}  // namespace slf
