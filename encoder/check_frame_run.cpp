// SPDX-License-Identifier: Apache-2.0
#include "encoder/check_frame_run.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "encoder/encode_to_target.h"

namespace slf {

Result<Done, InputError> check_frame_run(std::size_t frames, const EncoderSettings& s,
                                         const FrameSettings& f) {
  const auto refused = [](const std::string& what) {
    return InputError{Errc::kInvalidArgument, "frames: " + what};
  };
  if (frames == 0) return refused("there are none");
  if (has_target(s))
    return refused("a target of bytes or PSNR is of one light field; frames have a bitrate");
  if (!(s.target_bitrate >= 0) || !std::isfinite(s.target_bitrate))
    return refused("target bitrate: bits a second, above 0");
  if (s.quality_layers > 1) return refused("they have one quality layer");
  if (s.base_levels > 0) return refused("they have no base");
  if (s.geometry != GeometryCoder::kOctree || s.coefficients != CoefficientCoder::kVector)
    return refused("they are coded by the octree and vector coders");
  if (f.group < 1) return refused("a group has one at the least");
  if (f.part < 0 || f.part >= f.parts) return refused("part: 0 to the number of parts - 1");
  if (frames_of_part(frames, f).count == 0)
    return refused("there are more parts than groups of frames: fewer parts, or smaller groups");
  if (f.parts > 1 && s.target_bitrate > 0) return refused("a bitrate is of all parts together");
  if (!(f.rate > 0) || !std::isfinite(f.rate)) return refused("so many a second: above 0");
  return Done{};
}

Result<Done, InputError> of_frame(std::size_t f, const Result<Done, InputError>& checked) {
  if (checked) return Done{};
  return InputError{checked.error().code,
                    "frame " + std::to_string(f) + ": " + checked.error().message};
}

FramesOfPart frames_of_part(std::size_t frames, const FrameSettings& settings) {
  if (settings.group < 1 || settings.part < 0 || settings.part >= settings.parts) return {};
  const auto group = static_cast<std::size_t>(settings.group),
             part = static_cast<std::size_t>(settings.part),
             parts = static_cast<std::size_t>(settings.parts);
  const std::size_t groups = (frames + group - 1) / group;
  const auto begin = [&](std::size_t p) { return std::min(frames, groups * p / parts * group); };
  return {begin(part), begin(part + 1) - begin(part)};
}

}  // namespace slf
