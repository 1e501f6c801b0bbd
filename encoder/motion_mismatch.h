// SPDX-License-Identifier: Apache-2.0
// How well a motion foretells a frame. Informative.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "encoder/find_motion.h"
#include "encoder/matched_frame.h"
#include "geometry/reference_walk.h"

namespace slf {

/// Grey levels by which a frame differs from what its reference shows there, of a sample of points:
/// others than those that are matched, where there are enough.
class Mismatch {
 public:
  /// What a splat counts that moved, however well it is foretold: cells of all levels hold others
  /// beside it than they held before. One that stands still is nearly free.
  static constexpr double kMoved = 48;

  /// @param here, there  the same frames and their coarser ones, kept by reference
  Mismatch(const FramePoints& now, const FramePoints& before, int bits,
           const std::vector<CoarseFrame>& here, const std::vector<CoarseFrame>& there);

  /// Scattered points seldom meet the very voxel: they count at every level up to where half of
  /// them share a cell, since each of these levels is coded. Those that stand still count less.
  double of(const Motion& motion);

  /// Was the point of that number in the same voxel, in about the same colour?
  bool is_still(std::size_t point);

 private:
  struct Level {
    explicit Level(const std::vector<std::uint64_t>& codes) : cells(codes), index(cells) {}
    Level(const Level&) = delete;
    Level& operator=(const Level&) = delete;
    ReferenceLevel cells;
    ReferenceWalk index;
  };

  double of_voxels(const Motion& motion);
  double of_scattered(const Motion& motion);

  const FramePoints &now_, &before_;
  int bits_;
  const std::vector<CoarseFrame>&here_, &there_;
  std::vector<std::unique_ptr<Level>> levels_;
};

}  // namespace slf
