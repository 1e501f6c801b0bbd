// SPDX-License-Identifier: Apache-2.0
// What slf encode and slf igc begin with: the capture and its input cameras.
#pragma once

#include <cstdint>
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

/// What a capture may lack.
enum class PointsWanted : std::uint8_t {
  kNeeded,
  kOrPhotographs,  ///< photographs with cameras are enough
  kOrNone,         ///< so they are, and a cloud may have no points
};

/// Loads the capture, prints its warnings, and picks the cameras of the split.
Result<CaptureInput, Failure> load_input(const EncodeOptions& given, ProgressLine& line,
                                         PointsWanted wanted = PointsWanted::kNeeded);

}  // namespace slf::tools
