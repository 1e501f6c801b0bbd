// SPDX-License-Identifier: Apache-2.0
// What slf encode and slf igc begin with: the capture and its input cameras.
#pragma once

#include <vector>

#include "slf/capture.h"
#include "tools/encode_options.h"
#include "tools/failure.h"
#include "tools/progress.h"

namespace slf::tools {

struct CaptureInput {
  Capture capture;
  std::vector<int> cameras;  ///< of the split; empty where the capture has none
  Metadata metadata;         ///< source, split: for the file
  double seconds = 0;        ///< of loading
};

/// Loads the capture, prints its warnings, and picks the cameras of the split.
/// @param points_needed  CaptureOptions
Result<CaptureInput, Failure> load_input(const EncodeOptions& given, ProgressLine& line,
                                         bool points_needed = true);

}  // namespace slf::tools
