// All slices of a scene, several at a time. Spec 8.2.
#pragma once

#include "codec/base_decoder.h"
#include "codec/scene_units.h"
#include "codec/sequence_plan.h"
#include "slf/decoder.h"

namespace slf {

/// Slices whose values are decoded while the geometry of the next is: what they need beside their
/// output, some 40 bytes a point, is let go of after.
inline constexpr std::size_t kBatchPoints = std::size_t{1} << 19;

/// Appends their points to `field`, in order.
/// @param chosen   [slices] the others are passed over
/// @param seconds  receives what geometry and components took
/// @return is something missing?
/// @errors that of the unit which stands first in the stream, for any number of threads.
Result<bool> decode_slices(const SceneUnits& units, const SequencePlan& plan, const Base& base,
                           const std::vector<std::uint8_t>& chosen, int threads,
                           DecodeSeconds& seconds, LightField& field);

/// Leaves points from `begin` on that are in the region.
void keep_region(const SequencePlan& plan, std::size_t begin, LightField& field);

}  // namespace slf
