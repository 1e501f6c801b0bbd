// SPDX-License-Identifier: Apache-2.0
// How many points each frame of a stream has, by its slice table alone. Spec 7.13.
#include "codec/decoder/frame_chain.h"
#include "slf/frames.h"

namespace slf {

Result<std::vector<std::optional<std::uint64_t>>> list_points(std::span<const std::uint8_t> stream,
                                                              const DecodeLimits& limits) {
  SLF_TRY(const auto frames, split_frames(stream, limits.max_memory));
  std::vector<std::optional<std::uint64_t>> points;
  std::optional<OpenStream> group;
  for (const FrameUnits& frame : frames) {
    std::optional<OpenStream> predicted;
    if (!frame.header.predicted()) {
      const auto bytes = stream.subspan(static_cast<std::size_t>(frame.offset),
                                        static_cast<std::size_t>(frame.bytes));
      auto opened = open_stream(bytes, limits);
      group = opened ? std::optional(*std::move(opened)) : std::nullopt;
    } else if (group) {
      auto opened = open_predicted(stream, frame, *group, limits.max_memory);
      if (opened) predicted = *std::move(opened);
    }
    const auto& own = frame.header.predicted() ? predicted : group;
    points.push_back(own ? std::optional(own->scene.stream.table.num_points()) : std::nullopt);
  }
  return points;
}

}  // namespace slf
