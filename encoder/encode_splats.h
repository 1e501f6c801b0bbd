// Photographs to splats: what EncoderSettings::surface kSplats asks for.
#pragma once

#include <span>

#include "slf/encoder.h"

namespace slf {

/// @param start  where the capture's points are from
/// @errors kInvalidInput: photographs train nothing; those of train_gaussians, encode_gaussians
Result<Encoded, InputError> encode_splats(const Capture& capture, StartId start,
                                          std::span<const int> cameras,
                                          const EncoderSettings& settings,
                                          const Progress& progress);

}  // namespace slf
