// SPDX-License-Identifier: Apache-2.0
// All slices of a scene, several at a time. Spec 8.2.
#pragma once

#include "codec/decoder/decoder_state.h"
#include "slf/decoder.h"

namespace slf {

/// Points of slices that are begun and not done, where these are more than two slices a thread:
/// what they need beside their output, some 40 bytes a point, is let go of after.
inline constexpr std::size_t kPointsInFlight = std::size_t{1} << 18;

/// The base's components (8.6 - 8.8), which slices go on from, and beside them the slices, whose
/// points are appended to `field` in order.
/// @param chosen   [slices] the others are passed over
/// @param scene    the geometry of its base is there
/// @param seconds  receives what geometry and components took, of all threads together
/// @errors that of the base, else the one that stands first in the stream, for any number of
///         threads.
Result<Done> decode_slices(const SceneUnits& units, const Request& request,
                           const std::vector<std::uint8_t>& chosen, int threads, SceneState& scene,
                           DecodeSeconds& seconds, LightField& field);

/// Leaves points that are in the region.
void keep_region(const Request& request, LightField& field);

}  // namespace slf
