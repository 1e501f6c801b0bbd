// SPDX-License-Identifier: Apache-2.0
#include "attributes/moved_means.h"
#include "codec/frame_state.h"

namespace slf {

MovedFrame move_frame(const FrameState& state, const std::vector<PointMove>& moves,
                      const Motion& motion, int bits, std::size_t planes) {
  const MovedPoints moved = move_points(state.cells.codes(bits), moves, motion, bits);
  std::vector<std::uint64_t> codes;
  codes.reserve(moved.codes.size());
  for (const std::uint64_t code : moved.codes)
    if (codes.empty() || codes.back() != code) codes.push_back(code);
  MovedFrame frame;
  frame.cells = ReferenceCells(codes, bits);
  if (planes > 0) frame.means = moved_means(moved, state.means.back(), planes, bits);
  return frame;
}

}  // namespace slf
