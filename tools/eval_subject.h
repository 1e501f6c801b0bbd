// SPDX-License-Identifier: Apache-2.0
// What `slf eval` judges: a file, decoded.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "slf/frames.h"
#include "slf/gaussians.h"
#include "tools/eval_report.h"
#include "tools/stream_input.h"

namespace slf::tools {

/// A stream of frames that is open: in order each frame is decoded once.
struct FrameStream {
  StreamFile file;
  DecodeSeconds seconds;  ///< of the frame that was decoded last, and those that it needed
  std::optional<FrameDecoder> decoder;
};
Result<std::shared_ptr<FrameStream>, Failure> open_frames(const std::string& input,
                                                          const LimitOptions& limits,
                                                          const CommonOptions& common);

struct SubjectOptions {
  LimitOptions limits;
  CommonOptions common;
  int frame = -1;                 ///< place among the frames; -1: the file is one light field
  bool estimate_normals = false;  ///< of an .igc
  std::shared_ptr<FrameStream> frames = {};  ///< open, of the file; or none
};

/// A .slf or an .igc, with view maps.
Result<Subject, Failure> decode_subject(const std::string& input, const Capture& capture,
                                        const SubjectOptions& given);

/// Pictures of splats.
DrawPicture pictures_of(Gaussians gaussians);

/// A file of Gaussian splats, and their pictures.
struct SplatSubject {
  Subject subject;
  DrawPicture draw;
};
Result<SplatSubject, Failure> read_splat_subject(const std::string& input,
                                                 const LimitOptions& limits,
                                                 const CommonOptions& common);

}  // namespace slf::tools
