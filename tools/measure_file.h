// SPDX-License-Identifier: Apache-2.0
// What the pictures of a file that was just written are worth.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "slf/encoder.h"
#include "tools/failure.h"

namespace slf::tools {

/// The capture with the file's own points: what a capture without any is judged on.
Capture with_points_of(const LightField& field, Capture capture, int threads);

struct FilePictures {
  double psnr = 0;          ///< dB, as `slf eval` has it of images; NaN: nothing to compare
  std::size_t cameras = 0;  ///< that it is of: all of the input, or some where there are many
  double off_pixels = 0;    ///< ImageQuality::off_pixels of these
  int side = 0;             ///< the shorter one of the smallest of their photographs, pixels
  double seconds = 0;
};

/// Those of the input that were not dropped.
std::vector<int> used_cameras(const Encoded& encoded, std::vector<int> cameras);

/// Decodes the file and draws what the input cameras saw, 32 of them at most.
/// @param capture  what was encoded
Result<FilePictures, Failure> measure_file(const Encoded& encoded, const Capture& capture,
                                           std::span<const int> cameras, int threads);

/// The cameras where the encoder had them.
void take_poses(const PoseReport& poses, Capture& capture);

/// What to do where poses seem wrong, unless few or tiny photographs, or voxels of several pixels,
/// do not tell; and that pictures are unlike their photographs, where nobody chose the step or the
/// size of the file.
std::vector<std::string> picture_warnings(const FilePictures& pictures, const Encoded& encoded,
                                          const EncoderSettings& settings);

/// A line of the report.
std::string pictures_text(const FilePictures& pictures, const Encoded& encoded,
                          std::size_t input_cameras);

}  // namespace slf::tools
