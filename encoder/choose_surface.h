// SPDX-License-Identifier: Apache-2.0
// Which surface photographs are predicted best by: as given, mended, or trained.
#pragma once

#include <span>

#include "encoder/encode_splats.h"
#include "slf/encoder.h"

namespace slf {

/// The cloud on the grid, of the surface that settings.surface asks for.
/// @param start   where the capture's points are from: those of a volume have to be trained
/// @param report  receives what became of the points
/// @param splats  they may be chosen: report.kept is kSplats then, and the cloud is empty
/// @param cache   of the capture, if there will be another training
/// @errors those of voxelise_capture, refine_geometry, train_geometry, quick_quality, try_splats
///         and try_surface
Result<VoxelCloud, InputError> choose_surface(const Capture& capture, std::span<const int> cameras,
                                              const EncoderSettings& settings, StartId start,
                                              SurfaceReport& report, const Progress& progress,
                                              bool splats = false, TrainingCache* cache = nullptr);

}  // namespace slf
