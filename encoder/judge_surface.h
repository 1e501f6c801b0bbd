// How well a surface predicts photographs that were held out: what a surface is chosen by.
#pragma once

#include <span>

#include "slf/encoder.h"

namespace slf {

/// PSNR of all pixels of the held-out cameras' pictures, drawn from view maps of low degree that
/// are fitted to the others, dB. What the surface does not cover counts as what stands behind it.
/// @errors those of observe, fit_view_maps and load_image
Result<double, InputError> surface_psnr(const Capture& capture, std::span<const int> fitted,
                                        std::span<const int> held_out, const VoxelCloud& cloud,
                                        int threads);

}  // namespace slf
