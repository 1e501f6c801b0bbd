// SPDX-License-Identifier: Apache-2.0
// slf eval: what one capture says of a file, or of one of its frames.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "slf/evaluate.h"
#include "slf/frame_inputs.h"
#include "tools/eval_report.h"
#include "tools/eval_subject.h"
#include "tools/options.h"

namespace slf::tools {

struct EvalOptions {
  std::string input, capture, points, images, split, unquantised, error_maps;
  std::optional<WorldChange> world;       ///< --points-world
  std::string range;                      ///< A:B of captures in a directory of frames
  int frame = -1;                         ///< of a file of several
  std::optional<FrameInput> input_frame;  ///< that the capture is of
  bool split_given = false, no_images = false, estimate_normals = false;
  EvaluateSettings settings;
  std::optional<double> min_psnr, min_image_psnr;
  LimitOptions limits;
  CommonOptions common;
  std::shared_ptr<FrameStream> frames, unquantised_frames;  ///< open, of the two files; or none

  SubjectOptions decode() const { return {limits, common, frame, estimate_normals, frames}; }
  SubjectOptions decode_unquantised() const {
    return {limits, common, frame, estimate_normals, unquantised_frames};
  }
};

struct Judged {
  Subject subject;
  std::vector<Measured> measured;  ///< none: it has no points
  double seconds = 0;
};

Result<Judged, Failure> judge_capture(const EvalOptions& given);

/// The floors of --min-psnr and --min-image-psnr, on the held-out cameras, else on the input.
Outcome check_floors(const EvalOptions& given, const std::vector<Measured>& measured);

/// The whole of slf eval, of one capture.
Outcome eval_capture(const EvalOptions& given);

/// And of a directory of frames: each against its own, and the mean of all.
Outcome eval_frames(const EvalOptions& given);

}  // namespace slf::tools
