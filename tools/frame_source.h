// SPDX-License-Identifier: Apache-2.0
// The frames of a .slf file as input of a verb.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "slf/frames.h"
#include "tools/stream_input.h"

namespace slf::tools {

/// A stream of frames and its decoder: in order each frame is decoded once.
class FrameSource {
 public:
  StreamFile stream;
  std::optional<FrameDecoder> decoder;
  std::size_t last = 0;  ///< the greatest that is asked for: refused before work is done for others
};

/// Frame part.frame. Of a light field that does not move there is frame 0 alone.
Result<DecodedFile, Failure> decode_frame(const std::string& file, const PartOptions& part,
                                          const LimitOptions& given, const CommonOptions& common);

/// "0:N" for PartOptions::frames: every frame of a file, which part.source holds then.
Result<std::string, Failure> all_frames(const std::string& file, PartOptions& part,
                                        const LimitOptions& given, const CommonOptions& common);

/// Runs a verb, or with --frames once for each of them: part.frame and output are set for it.
/// @param extension  of files within a directory
/// @param output     whose %d becomes the frame's number
Outcome for_each_frame(const char* verb, const std::string& extension, std::string& output,
                       PartOptions& part, const std::function<Outcome()>& run);

/// Seconds of the last `count` frames that a verb has run for; none where pictures are not of
/// frames.
std::vector<double> times_of_last(const PartOptions& part, std::size_t count);

/// [F] of each frame; nothing where its headers do not say it.
using PointsOfFrames = std::vector<std::optional<std::uint64_t>>;

/// The frames of a light field that moves. What else `slf info` tells is about the first.
nlohmann::ordered_json frame_json(const FrameInfo& frame,
                                  const std::optional<std::uint64_t>& points);
/// A line.
std::string frames_text(const std::vector<FrameInfo>& frames);
/// One for each.
std::string frame_table_text(const std::vector<FrameInfo>& frames, const PointsOfFrames& points);

}  // namespace slf::tools
