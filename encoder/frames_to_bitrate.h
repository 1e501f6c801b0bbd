// SPDX-License-Identifier: Apache-2.0
// Bits a second of a sequence in place of a step. Informative.
#pragma once

#include <cstddef>

#include "slf/frames.h"

namespace slf {

/// Frames that can be coded as often as is asked for, all on one grid.
struct Sequence {
  std::size_t length;  ///< frames
  const LoadFrame& load;
  EncoderSettings settings;
  const FrameSettings& frames;
  Grid grid;
  bool clouds;          ///< no frame has cameras
  std::size_t chooser;  ///< the first frame with points: it chooses for all
  const Progress& progress;

  /// Codes some frames anew.
  /// @param q  Quantiser step, or kAutomaticQ
  Result<Done, InputError> code(double q, std::size_t first, std::size_t count,
                                const TakeFrame& take, EncodedFrames& encoded) const;
};

/// Codes the frames with the step for which all of them have 97 to 100 % of
/// settings.target_bitrate: first an intra frame and three that are predicted, then the whole, some
/// three to five times. Holds the bytes of two such runs. Where no step comes so near, that with
/// the most bytes within the rate stays, or else the one with the fewest; a warning says so.
Result<Done, InputError> code_to_bitrate(const Sequence& sequence, const TakeFrame& take,
                                         EncodedFrames& encoded);

}  // namespace slf
