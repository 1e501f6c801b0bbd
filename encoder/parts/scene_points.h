// SPDX-License-Identifier: Apache-2.0
// The points of a scene: from a capture onto the grid, and into files.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "encoder/parts/point_store.h"
#include "slf/encoder.h"

namespace slf {

/// One of both, as voxelise has them.
struct GridWanted {
  int bits = 0;
  double voxel_size = 0;
};

struct ScenePoints {
  Grid grid;
  PointStore::Written stored;
  std::size_t merged = 0;  ///< points that fell into an occupied voxel
};

/// With normals, those of the capture or estimated ones, where cameras or normal_bits need them.
/// @errors those of voxelise, kUnwritable
Result<ScenePoints, InputError> store_points(const Capture& capture, std::span<const int> cameras,
                                             const EncoderSettings& settings,
                                             const GridWanted& wanted,
                                             const std::filesystem::path& directory);

/// Bytes that store_points takes, the capture's own among them.
std::uint64_t memory_of_points(const Capture& capture, std::span<const int> cameras,
                               const EncoderSettings& settings);

}  // namespace slf
