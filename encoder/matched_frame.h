// SPDX-License-Identifier: Apache-2.0
// A frame that another is matched with, at one level: its surface and how colours change on it.
// Informative.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "encoder/find_motion.h"
#include "geometry/reference_walk.h"

namespace slf {

using Place = Eigen::Vector3d;

/// A frame with fewer, larger cells.
struct CoarseFrame {
  std::vector<std::uint64_t> codes;
  std::vector<Place> centres;  // in voxels
  std::vector<Place> colours;
};
/// dropped: levels of the grid.
CoarseFrame coarsen(const FramePoints& points, int dropped);

/// What one place asks of its displacement d: (weight d - wanted) is to be small.
struct Match {
  Place place;
  Eigen::Matrix3d weight;
  Place wanted;
};

class MatchedFrame {
 public:
  MatchedFrame(const MatchedFrame&) = delete;
  MatchedFrame& operator=(const MatchedFrame&) = delete;
  MatchedFrame(const FramePoints& points, int dropped)
      : frame_(coarsen(points, dropped)),
        index_(frame_.codes),
        walk_(index_),
        side_(std::ldexp(1.0, dropped)),
        known_(frame_.codes.size()),
        surface_(frame_.codes.size()) {}

  double side() const { return side_; }
  Match match(const Place& place, const Place& colour, const Place& guess);

 private:
  struct Surface {
    Place normal = Place::Zero();    ///< 0: not known
    Place gradient = Place::Zero();  ///< of the brightness, grey levels a voxel, along the surface
  };
  const Surface& surface(std::uint32_t at);
  /// Cells within so many of a place, no farther than the root of `square` from it, as far as
  /// their sides tell: step(cell).
  template <class Step>
  void for_cells(const Place& at, int reach, double square, const Step& step);
  std::uint32_t nearest(const Place& at);
  static double brightness(const Place& colour) { return colour.sum() / 3; }

  CoarseFrame frame_;
  ReferenceLevel index_;
  ReferenceWalk walk_;
  double side_;
  std::vector<bool> known_;
  std::vector<Surface> surface_;
};

}  // namespace slf
