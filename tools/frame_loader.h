// SPDX-License-Identifier: Apache-2.0
// The frames of slf encode, each loaded when it is its turn.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>

#include "slf/frame_inputs.h"
#include "slf/frames.h"
#include "slf/gaussian_frames.h"
#include "slf/plenoptic_frames.h"
#include "tools/capture_input.h"
#include "tools/encode_options.h"
#include "tools/progress.h"

namespace slf::tools {

/// Frames are loaded by the program, with their warnings: the first one's alone, all are alike.
class FrameLoader {
 public:
  /// @param views  a file of the positions of views, or empty
  FrameLoader(const EncodeOptions& given, const FrameInputs& inputs, const std::string& views,
              ProgressLine& line)
      : given_(given), inputs_(inputs), views_(views), line_(line) {}

  LoadFrame captures();
  LoadGaussians splats();
  LoadPlenoptic views();

  /// The result of a library call, which may have failed for what could not be loaded.
  template <class T>
  Result<T, Failure> from_frames(Result<T, InputError> result) const {
    if (!result && failure_) return *failure_;
    return from(given_.capture, std::move(result));
  }

 private:
  /// What the first splats had.
  struct Kind {
    std::string file;
    int degree;
    UpAxis up;
  };

  Result<CaptureInput, Failure> load_capture_of(const FrameInput& frame);
  Result<Gaussians, Failure> load_splats_of(const FrameInput& frame);
  Result<PlenopticCloud, Failure> load_views_of(const FrameInput& frame);
  template <class T>
  Result<T, InputError> kept(Result<T, Failure> loaded);

  const EncodeOptions& given_;
  const FrameInputs& inputs_;
  std::string views_;
  ProgressLine& line_;
  bool loaded_ = false;
  std::optional<Kind> kind_;
  std::optional<PlenopticCloud> like_;  // the first with views, without its points
  std::optional<Failure> failure_;      // why a frame could not be loaded, with the exit code
};

}  // namespace slf::tools
