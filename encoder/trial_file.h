// SPDX-License-Identifier: Apache-2.0
// What a file is worth, before it is made of all photographs: what a surface or splats are chosen
// by.
#pragma once

#include <span>

#include "encoder/judge_surface.h"
#include "slf/encoder.h"

namespace slf {

/// dB: the mean of PSNR and of SSIM, as -10 log10(1 - SSIM), less what a doubling of bytes has to
/// gain. SSIM alone would take what is blurred at highlights, PSNR alone what has lost its texture.
/// Where outlines tell the object, the mean of what all pixels and what the object's say: a person
/// looks at it, and before a wide background its pixels are few.
double worth_of(const TrialFile& file);

/// The same without the bytes.
double look_of(const TrialFile& file);
double look_of(const DrawnQuality& drawn);

TrialFile trial_of(const DrawnQuality& drawn, std::size_t bytes);

/// A file of a surface, of some cameras, for others: fitted, quantised and coded as the surface
/// would be if it were chosen, but for the cross-validation of the fit.
/// @param cloud  with normals
/// @errors those of fit_capture, choose_step, pack and load_image
Result<TrialFile, InputError> try_surface(const Capture& capture, std::span<const int> fitted,
                                          std::span<const int> held_out, const VoxelCloud& cloud,
                                          const EncoderSettings& settings,
                                          const Progress& progress);

}  // namespace slf
