// Which surface photographs are predicted best by: as given, mended, or trained.
#pragma once

#include <span>

#include "slf/encoder.h"

namespace slf {

/// The cloud on the grid, of the surface that settings.surface asks for.
/// @param report  receives what became of the points
/// @errors those of voxelise_capture, refine_geometry, train_geometry and surface_psnr
Result<VoxelCloud, InputError> choose_surface(const Capture& capture, std::span<const int> cameras,
                                              const EncoderSettings& settings,
                                              SurfaceReport& report, const Progress& progress);

}  // namespace slf
