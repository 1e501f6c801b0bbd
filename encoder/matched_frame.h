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
  std::vector<Place> centres;      // in voxels
  std::vector<double> brightness;  // grey levels
  std::vector<double> points;      // in each cell
};
/// A frame and its `levels` coarser ones, the frame first. O(points)
std::vector<CoarseFrame> coarser_frames(const FramePoints& points, int levels);

/// What one place asks of its displacement d: (weight d - wanted) is to be small.
struct Match {
  Place place;
  Eigen::Matrix3d weight;
  Place wanted;
};

class MatchedFrame {
 public:
  static constexpr std::uint32_t kNone = ReferenceLevel::kNone;

  MatchedFrame(const MatchedFrame&) = delete;
  MatchedFrame& operator=(const MatchedFrame&) = delete;
  /// frame: kept by reference. dropped: levels of the grid that it lacks. scattered: where no
  /// surface is to be seen, places are matched with the nearest point itself
  MatchedFrame(const CoarseFrame& frame, int dropped, bool scattered = false)
      : frame_(frame),
        index_(frame_.codes),
        walk_(index_),
        side_(std::ldexp(1.0, dropped)),
        scattered_(scattered),
        known_(frame_.codes.size()),
        surface_(frame_.codes.size()) {}

  double side() const { return side_; }
  /// last: the cell that the place was matched with before, or kNone; has the one of now after
  Match match(const Place& place, double brightness, const Place& guess, std::uint32_t& last);

 private:
  struct Surface {
    Place normal = Place::Zero();    ///< 0: not known
    Place gradient = Place::Zero();  ///< of the brightness, grey levels a voxel, along the surface
  };
  const Surface& surface(std::uint32_t at);
  Voxel cell_of(const Place& at) const;
  /// Occupied cells of a box: step(place among the codes).
  template <class Step>
  void for_cells(const Voxel& low, const Voxel& high, const Step& step);
  std::uint32_t nearest(const Place& at, std::uint32_t last);

  const CoarseFrame& frame_;
  ReferenceLevel index_;
  ReferenceWalk walk_;
  double side_;
  bool scattered_;
  std::vector<bool> known_;
  std::vector<Surface> surface_;
};

}  // namespace slf
