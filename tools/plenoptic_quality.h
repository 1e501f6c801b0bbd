// SPDX-License-Identifier: Apache-2.0
// What slf eval says of the views of a plenoptic cloud.
#pragma once

#include <cstddef>
#include <vector>

#include "slf/frame_inputs.h"
#include "slf/plenoptic.h"
#include "tools/eval_capture.h"
#include "tools/plenoptic_options.h"

namespace slf::tools {

/// Views of one kind.
struct ViewGroup {
  const char* name;
  std::vector<std::size_t> views;
};
/// Those that are coded, and those that are held out if there are some.
std::vector<ViewGroup> view_groups(std::size_t views, const std::vector<int>& held_out);

/// Mean of decibels; infinite where all are exact, and NaN of none.
double mean_of(const PlenopticQuality& quality, const std::vector<std::size_t>& views,
               std::size_t channel);

/// slf eval of a file of frames that are such clouds: each against its own, and the mean of all.
/// @param given   its frames are open
/// @param inputs  as many clouds; with given.frame the one of that frame alone
Outcome eval_plenoptic_frames(const EvalOptions& given, const FrameInputs& inputs);

}  // namespace slf::tools
