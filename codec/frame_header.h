// SPDX-License-Identifier: Apache-2.0
// The frame unit: which instant a frame is of, and what it is predicted from. Spec 7.13.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

#include "bitstream/syntax.h"
#include "geometry/motion.h"
#include "geometry/moved_points.h"
#include "geometry/reference_cells.h"
#include "slf/error.h"

namespace slf {

struct FrameHeader {
  std::uint32_t frame_number = 0;
  double frame_time = 0;  ///< seconds
  std::uint32_t frame_predicted_flag = 0;
  std::uint32_t frame_bytes = 0;  ///< behind this unit, the end unit included
  std::uint32_t frame_motion_flag = 0, frame_lattice_flag = 0;
  Motion motion;
  bool moves_points = false;     ///< of the reference, one by one: 8.12.7
  std::vector<PointMove> moves;  ///< of each of them

  bool predicted() const { return frame_predicted_flag != 0; }
  bool has_lattice() const { return motion.lattice_log2 > 0; }
  /// frame_lattice_log2 says both: with points that move it is 0, or kLatticeBeside more.
  static constexpr int kWidestLattice = 8, kLatticeBeside = 6;
  int lattice_code() const {
    return motion.lattice_log2 + (moves_points && has_lattice() ? kLatticeBeside : 0);
  }
  void set_lattice_code(int code) {
    moves_points = code == 0 || code > kWidestLattice;
    motion.lattice_log2 = code - (code > kWidestLattice ? kLatticeBeside : 0);
  }
};

inline constexpr std::int64_t kMostFrames = std::int64_t{1} << 31;
inline constexpr std::int64_t kMostLattice = 1 << 18;  ///< points

// Spec 7.13  frame_motion( )
template <class V, class Header>
void frame_motion(V& v, Header& h) {
  for (auto& row : h.motion.matrix)
    for (auto& entry : row)
      v.se("frame_matrix", entry, Range{-Motion::kMostEntry, Motion::kMostEntry});
  for (auto& shift : h.motion.shift)
    v.se("frame_shift", shift, Range{-Motion::kMostShift, Motion::kMostShift});
  v.u(1, "frame_lattice_flag", h.frame_lattice_flag, Range{0, 1});
  if (!h.frame_lattice_flag) return;
  int code = h.lattice_code();
  v.u(4, "frame_lattice_log2", code, defined(0, 14));
  v.require(code == 0 || code > 2, Errc::kUnsupported, "frame_lattice_log2");
  if constexpr (!std::is_const_v<Header>) h.set_lattice_code(code);
  if (code == 0) return;
  for (auto& first : h.motion.lattice_first)
    v.ue("frame_lattice_first", first, Range{0, (1 << 18) - 1});
  std::int64_t points = 1;
  for (auto& size : h.motion.lattice_size) {
    v.ue("frame_lattice_size_minus1", size, Range{0, kMostLattice / points - 1});
    if (!v.ok()) return;
    points *= std::int64_t{size} + 1;
  }
}

// Spec 7.13  frame_unit( )
template <class V, class Header>
void frame_unit(V& v, Header& h) {
  v.ue("frame_number", h.frame_number, Range{0, kMostFrames - 1});
  v.f64("frame_time", h.frame_time, false);
  v.u(1, "frame_predicted_flag", h.frame_predicted_flag, Range{0, 1});
  v.ue("frame_bytes", h.frame_bytes, Range{0, kMostFrames - 1});
  if (!h.frame_predicted_flag) return;
  v.u(1, "frame_motion_flag", h.frame_motion_flag, Range{0, 1});
  if (h.frame_motion_flag) frame_motion(v, h);
}

/// The elements; vectors are still to be read.
/// @param vectors  what follows the elements
Result<FrameHeader> parse_frame_header(std::span<const std::uint8_t> payload,
                                       std::span<const std::uint8_t>& vectors);
/// The payload: the elements and the vectors as they were coded.
/// @errors kInvalidArgument: an element that a reader would refuse
Result<std::vector<std::uint8_t>, InputError> frame_payload(FrameHeader header,
                                                            std::span<const std::uint8_t> vectors);

/// The payload. Vectors that are not coded become zero in `header`.
/// @param reference  of a predicted frame
/// @errors those of frame_payload
Result<std::vector<std::uint8_t>, InputError> write_frame_header(FrameHeader& header,
                                                                 const ReferenceCells* reference,
                                                                 int bits);

}  // namespace slf
