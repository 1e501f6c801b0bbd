// SPDX-License-Identifier: Apache-2.0
// Photographs to splats: what EncoderSettings::surface kSplats asks for.
#pragma once

#include <cstddef>
#include <span>

#include "slf/encoder.h"

namespace slf {

/// What splats of some cameras are worth to others.
struct JudgedSplats {
  double psnr = 0;        ///< dB, as surface_psnr; 0: photographs agree on no splat
  std::size_t bytes = 0;  ///< of the file
};

/// @param start  where the capture's points are from
/// @errors those of train_gaussians, encode_gaussians and load_image
Result<JudgedSplats, InputError> judge_splats(const Capture& capture, StartId start,
                                              std::span<const int> fitted,
                                              std::span<const int> held_out,
                                              const EncoderSettings& settings,
                                              const Progress& progress);

/// Whether no setting asks for what only a surface has, or for bytes that splats take another way.
bool may_be_splats(const EncoderSettings& settings);

/// Whether splats are so much better than the best surface, at no more bytes, that they are taken.
/// @param points  of that surface
bool splats_win(const SurfaceReport& report, std::size_t points);

/// @param start  where the capture's points are from
/// @errors kInvalidInput: photographs train nothing; those of train_gaussians, encode_gaussians
Result<Encoded, InputError> encode_splats(const Capture& capture, StartId start,
                                          std::span<const int> cameras,
                                          const EncoderSettings& settings,
                                          const Progress& progress);

}  // namespace slf
