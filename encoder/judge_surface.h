// SPDX-License-Identifier: Apache-2.0
// How well a surface predicts photographs that were held out: what a surface is chosen by.
#pragma once

#include <functional>
#include <span>

#include "slf/encoder.h"
#include "slf/render.h"

namespace slf {

/// Quality of some photographs' pictures. What is not drawn counts as what stands behind it.
struct DrawnQuality {
  double psnr = 0;  ///< dB, of all pixels
  double ssim = 0;
  /// The object's, as photographs outline it, whatever is drawn; 0: they do not tell.
  double inside_psnr = 0, inside_ssim = 0;
};

/// Quality of the held-out cameras' pictures, drawn from view maps of low degree that are fitted to
/// the others.
/// @errors those of observe, fit_view_maps and load_image
Result<DrawnQuality, InputError> quick_quality(const Capture& capture, std::span<const int> fitted,
                                               std::span<const int> held_out,
                                               const VoxelCloud& cloud, int threads);

/// The same for a surface that was decoded.
/// @errors those of load_image
Result<DrawnQuality, InputError> surface_quality(const Capture& capture,
                                                 std::span<const int> cameras,
                                                 const LightField& field, int threads);

/// Quality of what `draw` draws over black for cameras of a capture (in its own coordinates),
/// against their photographs.
/// @param draw  called by several threads
/// @errors those of load_image
Result<DrawnQuality, InputError> pictures_quality(
    const Capture& capture, std::span<const int> cameras,
    const std::function<Rendering(const Camera&)>& draw, int threads);

}  // namespace slf
