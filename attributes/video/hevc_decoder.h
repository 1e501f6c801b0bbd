// SPDX-License-Identifier: Apache-2.0
// The one place that includes libde265: pictures coded as HEVC.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "attributes/video/hevc_stream.h"
#include "attributes/video/picture.h"
#include "slf/error.h"

namespace slf {

/// Decodes an Annex B byte stream of exactly `expected.pictures` pictures.
/// @param sink  called with 0, 1, ... and the pictures in output order, on this thread. What it
///              was given counts only if the call succeeds.
/// @errors those of split_hevc, before any sample is decoded. kTruncated: fewer pictures.
///         kOutOfRange: damage that the decoder noticed. Damage that is valid HEVC cannot be
///         noticed: callers check a digest.
///         kUnsupported: this build has no libde265 (SLF_HEVC).
/// Thread-safe; one thread of its own caller. Memory: up to 30 decoded pictures.
Result<Done> decode_hevc(std::span<const std::uint8_t> stream, const HevcFormat& expected,
                         const std::function<void(std::size_t, const Picture&)>& sink);

}  // namespace slf
