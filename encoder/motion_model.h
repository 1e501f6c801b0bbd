// SPDX-License-Identifier: Apache-2.0
// A motion that is looked for: an affine one, and a lattice. Informative.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "encoder/matched_frame.h"
#include "geometry/motion.h"

namespace slf {

/// Displacements, in voxels, as a function of the place.
class MotionModel {
 public:
  explicit MotionModel(int bits) : centre_(Place::Constant(std::ldexp(0.5, bits))) {}

  Place affine(const Place& p) const { return matrix_ * (p - centre_) + shift_; }
  Place at(const Place& p) const { return side_ > 0 ? Place(affine(p) + added(p)) : affine(p); }
  /// What the lattice adds to the affine part.
  Place added(const Place& p) const {
    Place d = Place::Zero();
    for_corners(p, [&](std::size_t i, double w) { d += w * lattice_[i]; });
    return d;
  }
  int lattice_log2() const { return log2_; }

  /// What a decoder makes of a motion, on places of `points`.
  void start_from(const Motion& motion, const CoarseFrame& points);
  /// A lattice over all places of `points`, which adds nothing.
  void begin_lattice(const CoarseFrame& points, int log2);
  /// One of half the distance in its place, which is the same motion.
  void refine_lattice(const CoarseFrame& points);

  /// A lattice that adds a motion where fewer than half of the points around stand still.
  void begin_part(const CoarseFrame& points, int log2, const MotionModel& moving,
                  const std::vector<bool>& still);

  /// The cell that a place is in: points of the lattice, and how much each counts.
  struct Corners {
    std::array<std::size_t, 8> point;
    std::array<double, 8> weight;
  };
  Corners corners_of(const Place& p) const {
    std::array<int, 3> cell{};
    std::array<double, 3> in{};
    for (std::size_t i = 0; i < 3; ++i) {
      const double at = p[static_cast<int>(i)] / side_ - first_[i];
      cell[i] = std::clamp(static_cast<int>(std::floor(at)), 0, std::max(size_[i] - 2, 0));
      in[i] = std::clamp(at - cell[i], 0.0, 1.0);
    }
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) {
      double w = 1;
      std::size_t index = 0;
      for (std::size_t i = 3; i-- > 0;) {
        const int upper = static_cast<int>(c >> i & 1);
        w *= upper ? in[i] : 1 - in[i];
        index = index * static_cast<std::size_t>(size_[i]) +
                static_cast<std::size_t>(std::min(cell[i] + upper, size_[i] - 1));
      }
      corners.point[c] = index;
      corners.weight[c] = w;
    }
    return corners;
  }
  template <class Step>
  void for_corners(const Place& p, const Step& step) const {
    const Corners corners = corners_of(p);
    for (std::size_t c = 0; c < 8; ++c)
      if (corners.weight[c] > 0) step(corners.point[c], corners.weight[c]);
  }

  /// Least squares of what matches ask for.
  void fit_affine(const std::vector<Match>& matches);

  /// The same of the lattice, beside the affine part: conjugate gradients.
  /// stiffness: of the lattice, 0 .. 1
  void fit_lattice(const std::vector<Match>& matches, double stiffness);

  Motion rounded() const;

 private:
  /// A lattice over all places of `points`, which adds what that of `other` does.
  void sample_lattice(const MotionModel& other, const CoarseFrame& points, int log2);
  /// What the matches in a cell of the lattice ask of its eight points together.
  struct CellSums {
    std::array<std::size_t, 8> point;
    Eigen::Matrix<double, 24, 24> normal;
  };
  std::vector<CellSums> sum_cells(const std::vector<Match>& matches) const;
  /// Neighbours on the lattice are alike, and small.
  void add_stiffness(const std::vector<Place>& x, std::vector<Place>& y) const;

  Place centre_, shift_ = Place::Zero();
  Eigen::Matrix3d matrix_ = Eigen::Matrix3d::Zero();
  int log2_ = 0;
  double side_ = 0, stiffness_ = 0;
  std::array<int, 3> first_{}, size_{};
  std::vector<Place> lattice_;
};

}  // namespace slf
