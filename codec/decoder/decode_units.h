// SPDX-License-Identifier: Apache-2.0
// The decoder behind the splitting of a stream into units.
#pragma once

#include "codec/decoder/request.h"
#include "codec/scene_units.h"
#include "slf/decoder.h"

namespace slf {

/// What a frame of several has beside its units.
struct FrameContext {
  const FrameReference* reference = nullptr;  ///< of a predicted frame
  FrameState* kept = nullptr;                 ///< receives what the next is predicted from
  const GroupRequest* group = nullptr;        ///< of a predicted frame: that of its group
  GroupRequest* asked = nullptr;              ///< receives it
};

/// Units to the light field. Spec 8.
/// @param opened  its header may say that more is left out than the sequence unit does
Result<LightField> decode_units(const OpenStream& opened, const DecodeOptions& options,
                                const FrameContext& frame = {});

}  // namespace slf
