// SPDX-License-Identifier: Apache-2.0
// From photographs to Gaussian splats.
#pragma once

#include <span>
#include <vector>

#include "encoder/measure/outlines.h"
#include "encoder/train/train_geometry.h"
#include "encoder/train/train_surfels.h"
#include "encoder/train/trained_surfel.h"
#include "encoder/train/training_view.h"
#include "slf/gaussians.h"

namespace slf {

inline constexpr std::size_t kFewestSplats = 500;  ///< that any limit leaves

/// Surfels that are drawn as Gaussians while they are trained, flat ones as splats: drawn by
/// GaussianRenderer they are what photographs were compared with. Nothing pulls them to a surface,
/// and half as many as a surface has say more at equal bytes (the dino, 8,000 at Q 14: 66 kB
/// 30.8 dB; 4,000 at Q 7: 48 kB 31.0 dB).
/// @param settings  grid and voxel size have no meaning
/// @errors those of load_image. Empty where no surfels are left.
/// The same for any thread count. Time and memory: train_geometry's without fusing.
Result<Gaussians, InputError> train_gaussians(const Capture& capture, std::span<const int> cameras,
                                              const TrainGeometrySettings& settings,
                                              const Progress& progress = {});

/// The same before they are splats; empty where photographs train nothing.
Result<TrainedSurfels, InputError> train_gaussian_surfels(const Capture& capture,
                                                          std::span<const int> cameras,
                                                          const TrainGeometrySettings& settings,
                                                          const Progress& progress = {});

/// What every training of Gaussians has in common: views that are drawn so, settings.
/// @param is_volume  they begin anywhere, and all as faint
void train_as_gaussians(bool is_volume, std::vector<TrainingView>& views, TrainSettings& training);

/// Leaves out surfels outside of the object, where outlines tell (encoder/measure/outlines.h): what
/// photographs show of a background (shades of a stand, of a cloth) is smoke before any other.
void keep_object(const std::vector<Outline>& outlines, int threads, TrainedSurfels& surfels);

/// surface_of_splats (slf/splat_surface.h) of places that are the capture's plus `origin`.
Result<PointCloud, InputError> surface_of_splats_from(const Vec3& origin, const Gaussians& splats,
                                                      const Capture& capture,
                                                      std::span<const int> cameras, int threads);

/// Surfels that were trained as Gaussians.
Gaussians gaussians_of(const TrainedSurfels& surfels);

}  // namespace slf
