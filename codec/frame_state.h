// SPDX-License-Identifier: Apache-2.0
// What a frame leaves to the one that is predicted from it. Spec 8.12.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "attributes/coefficient_models.h"
#include "attributes/reference_means.h"
#include "geometry/moved_points.h"
#include "geometry/occupancy_states.h"
#include "geometry/reference_cells.h"

namespace slf {

/// By place: in the list of the units of its slice.
struct FrameState {
  ReferenceCells cells;
  LevelMeans means;
  std::vector<std::optional<OccupancyStates>> octree;
  std::vector<std::optional<CoefficientStates>> coefficients;

  /// Bytes of memory. of_coefficients: what the states of a group take
  std::uint64_t bytes(std::uint64_t of_coefficients) const {
    std::uint64_t sum = cells.bytes();
    for (const auto& level : means) sum += level.size() * sizeof(std::int32_t);
    for (const auto& states : octree)
      if (states)
        sum += OccupancyStates::bytes(std::uint64_t{1} << (states->hashed_bits - 5)) +
               OccupancyStates::kReferenceBytes;
    for (const auto& states : coefficients) sum += states ? of_coefficients : 0;
    return sum;
  }

  /// Means of zero of the root and `levels` levels below.
  void make_room(int levels, std::size_t planes) {
    for (int l = static_cast<int>(means.size()); l <= levels; ++l)
      means.emplace_back(cells.codes(l).size() * planes);
  }
};

/// A frame whose points have moved one by one. Spec 8.12.7
struct MovedFrame {
  ReferenceCells cells;
  LevelMeans means;
  Motion still;  ///< they are where they belong

  std::uint64_t bytes() const {  ///< of memory
    std::uint64_t sum = cells.bytes();
    for (const auto& level : means) sum += level.size() * sizeof(std::int32_t);
    return sum;
  }
};

/// @param moves   of every point
/// @param planes  of values; the frame has means of all levels where there are some
MovedFrame move_frame(const FrameState& state, const std::vector<PointMove>& moves,
                      const Motion& motion, int bits, std::size_t planes);

/// A frame that another is predicted from, and the motion between them.
struct FrameReference {
  /// terms: of the frame that is predicted, as far as they were found
  FrameReference(const FrameState& from, const Motion& motion, int bits, LevelTerms& found)
      : state(from), moved{from.cells, motion, bits}, terms(found), values(from.means) {}
  FrameReference(const FrameState& from, const MovedFrame& points, int bits, LevelTerms& found)
      : state(from),
        moved{points.cells, points.still, bits},
        terms(found),
        values(points.means),
        bytes_moved(points.bytes()) {}

  const FrameState& state;
  MovedReference moved;
  LevelTerms& terms;
  const LevelMeans& values;
  std::uint64_t bytes_moved = 0;  ///< of memory, beside those of the frame

  ReferenceMeans means() const { return {moved, values, terms}; }
};

}  // namespace slf
