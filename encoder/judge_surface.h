// SPDX-License-Identifier: Apache-2.0
// How well a surface predicts photographs that were held out: what a surface is chosen by.
#pragma once

#include <functional>
#include <span>

#include "slf/encoder.h"
#include "slf/render.h"

namespace slf {

/// PSNR of all pixels of the held-out cameras' pictures, drawn from view maps of low degree that
/// are fitted to the others, dB. What the surface does not cover counts as what stands behind it.
/// @errors those of observe, fit_view_maps and load_image
Result<double, InputError> surface_psnr(const Capture& capture, std::span<const int> fitted,
                                        std::span<const int> held_out, const VoxelCloud& cloud,
                                        int threads);

/// PSNR of all pixels of photographs of a capture against what `draw` draws of their cameras (in
/// the capture's own coordinates) over black, dB.
/// @param draw  called by several threads
/// @errors those of load_image
Result<double, InputError> pictures_psnr(const Capture& capture, std::span<const int> cameras,
                                         const std::function<Rendering(const Camera&)>& draw,
                                         int threads);

}  // namespace slf
