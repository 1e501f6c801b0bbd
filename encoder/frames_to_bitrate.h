// SPDX-License-Identifier: Apache-2.0
// Bits a second of a sequence in place of a step. Informative.
#pragma once

#include <cstddef>
#include <functional>

#include "slf/frames.h"

namespace slf {

/// Frames that can be coded as often as is asked for, all on one grid.
struct RateJob {
  std::size_t length;   ///< frames
  std::size_t chooser;  ///< the first frame with points: it chooses for all
  const FrameSettings& frames;
  double bitrate;  ///< bits a second
  double guess;    ///< the step to begin with
  /// Codes `count` frames from `first` on anew, with one step.
  std::function<Result<Done, InputError>(double q, std::size_t first, std::size_t count,
                                         const TakeFrame& take, EncodedFrames& encoded)>
      code;
};

/// Codes the frames with the step for which all of them have 97 to 100 % of
/// the bitrate: first an intra frame and three that are predicted, then the whole, some
/// three to five times. Holds the bytes of two such runs. Where no step comes so near, that with
/// the most bytes within the rate stays, or else the one with the fewest; a warning says so.
Result<Done, InputError> code_to_bitrate(const RateJob& job, const TakeFrame& take,
                                         EncodedFrames& encoded);

}  // namespace slf
