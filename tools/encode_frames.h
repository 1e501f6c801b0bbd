// SPDX-License-Identifier: Apache-2.0
// slf encode of frames: a directory of captures or clouds, an instant each.
#pragma once

#include <string>
#include <vector>

#include "tools/encode_options.h"
#include "tools/frame_choices.h"
#include "tools/plenoptic_options.h"

namespace slf::tools {

struct FrameOptions {
  std::string range;  ///< A:B of the numbers in the names
  int group = 16;
  double rate = 30;
  bool refit = false;  ///< points that stand still, too
  std::string part;    ///< "i/n", from 1
  std::string given;   ///< an option that means something for frames alone; or empty
  PlenopticVerbOptions plenoptic;
  bool dry_run = false;
  std::vector<GivenOption> options;  ///< all that stand on the command line
};
void add_frames(CLI::App& verb, FrameOptions& options);

/// Is the input a list of frames, or was one asked for?
bool is_frame_input(const EncodeOptions& given, const FrameOptions& frames);

Outcome encode_frame_list(const EncodeOptions& given, const FrameOptions& frames);

}  // namespace slf::tools
