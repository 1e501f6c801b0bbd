// SPDX-License-Identifier: Apache-2.0
// What `slf eval` judges: a file, decoded.
#pragma once

#include <functional>
#include <string>

#include "slf/gaussians.h"
#include "tools/eval_report.h"
#include "tools/stream_input.h"

namespace slf::tools {

struct SubjectOptions {
  LimitOptions limits;
  CommonOptions common;
  int frame = -1;                 ///< place among the frames; -1: the file is one light field
  bool estimate_normals = false;  ///< of an .igc
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

/// DIR/NUMBER_NAME.png of every camera's error map; the folders of its name become part of the
/// file's, and its extension is left out.
std::function<Result<Done, InputError>(int, const Image&)> error_map_writer(
    const std::string& directory, const Capture& capture);

}  // namespace slf::tools
