// SPDX-License-Identifier: Apache-2.0
// From photographs and whatever points there are to a surface that predicts photographs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_cache.h"
#include "slf/capture.h"
#include "slf/error.h"
#include "slf/types.h"

namespace slf {

inline constexpr std::size_t kLeastTrainingCameras = 5;  // fewer show no place twice over

class CameraTwists;
struct TrainingView;

struct TrainGeometrySettings {
  int grid_bits = 0;        ///< of the grid that follows; 0: as fine as photographs resolve
  double voxel_size = 0;    ///< > 0: in place of grid_bits
  int iterations = 3000;    ///< of training, one photograph each
  bool is_volume = false;   ///< the points are anywhere: all of them are let be seen at first
  std::size_t surfels = 0;  ///< most; 0: as the photographs resolve
  double seconds = 0;       ///< > 0: of training, about; results then depend on the machine
  double photograph_bytes = double(1 << 30);  ///< most, as floats: they are halved to fit
  std::filesystem::path work = {};            ///< TrainSettings
  bool resume = false;
  CameraTwists* twists = nullptr;  ///< of splats: poses are trained with them, and left there
  TrainingCache* cache = nullptr;  ///< of the capture; or none
  int threads = 0;
};

struct TrainedGeometry {
  PointCloud cloud;       ///< positions and normals, on a lattice of voxel_size; empty: nothing was
                          ///< found that photographs agree on
  double voxel_size = 0;  ///< voxelise with it, or points alias with the grid
  double pixel = 0;       ///< of the sharpest photographs, on the surface
  TrainedSurfels surfels;
};

/// Why photographs cannot train a surface; empty: they can.
std::string training_obstacle(const Capture& capture, std::span<const int> cameras);

/// Trains surfels that start on the capture's points (fit or guessed normals), then fuses what they
/// show in every photograph into one layer of points.
/// @param cameras  no other photograph is looked at
/// @param trained  by some of the cameras: the last fifth of training is done again with all of
///                 them; or empty
/// @errors those of load_image
/// The same for any thread count. Time: iterations (pixels + surfels). Memory: photographs as
/// floats at up to a megapixel each, and the nodes near the surface.
Result<TrainedGeometry, InputError> train_geometry(const Capture& capture,
                                                   std::span<const int> cameras,
                                                   const TrainGeometrySettings& settings,
                                                   TrainedSurfels trained = {},
                                                   const Progress& progress = {});

/// What surfels show in photographs' cameras, fused into one layer; without points where that is
/// next to nothing.
/// @param views  of the cameras
TrainedGeometry geometry_of(TrainedSurfels surfels, const Capture& capture,
                            std::span<const int> cameras, std::span<const TrainingView> views,
                            const TrainGeometrySettings& settings);

}  // namespace slf
