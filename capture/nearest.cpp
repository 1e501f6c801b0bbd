// SPDX-License-Identifier: Apache-2.0
#include "capture/nearest.h"

#include <cassert>
#include <cstddef>
#include <limits>
#include <nanoflann.hpp>
#include <vector>

namespace slf {

namespace {

struct Points {
  std::span<const std::array<float, 3>> points;

  std::size_t kdtree_get_point_count() const { return points.size(); }
  double kdtree_get_pt(std::size_t index, std::size_t axis) const {
    return static_cast<double>(points[index][axis]);
  }
  template <class BoundingBox>
  bool kdtree_get_bbox(BoundingBox&) const {
    return false;  // nanoflann computes it
  }
};

using Index = nanoflann::KDTreeSingleIndexAdaptor<
    nanoflann::L2_Simple_Adaptor<double, Points, double, std::uint32_t>, Points, 3, std::uint32_t>;

// The k best so far, ascending in (distance, index). nanoflann's own result set keeps whichever of
// several equally distant points the tree visits first.
class NearestSet {
 public:
  using DistanceType = double;

  NearestSet(std::uint32_t* indices, double* distances, std::size_t k)
      : indices_(indices), distances_(distances), k_(k) {}

  std::size_t size() const { return size_; }
  bool full() const { return size_ == k_; }

  // A little more than the worst, so that the tree's strict comparison lets ties through and its
  // rounding loses none; addPoint decides.
  double worstDist() const {
    return full() ? distances_[k_ - 1] * (1 + 1e-9) + std::numeric_limits<double>::min()
                  : std::numeric_limits<double>::max();
  }

  bool addPoint(double distance, std::uint32_t index) {
    if (full() && !before(distance, index, k_ - 1)) return true;
    std::size_t at = full() ? k_ - 1 : size_++;
    for (; at > 0 && before(distance, index, at - 1); --at) {
      distances_[at] = distances_[at - 1];
      indices_[at] = indices_[at - 1];
    }
    distances_[at] = distance;
    indices_[at] = index;
    return true;  // go on
  }

 private:
  bool before(double distance, std::uint32_t index, std::size_t at) const {
    return distance < distances_[at] || (distance == distances_[at] && index < indices_[at]);
  }

  std::uint32_t* indices_;
  double* distances_;
  std::size_t k_;
  std::size_t size_ = 0;
};

}  // namespace

struct NearestPoints::Tree {
  explicit Tree(std::span<const std::array<float, 3>> data)
      : points{data}, index(3, points, nanoflann::KDTreeSingleIndexAdaptorParams(10)) {}

  Points points;
  Index index;
};

NearestPoints::NearestPoints(std::span<const std::array<float, 3>> points)
    : tree_(std::make_unique<Tree>(points)) {}
NearestPoints::~NearestPoints() = default;
NearestPoints::NearestPoints(NearestPoints&&) noexcept = default;
NearestPoints& NearestPoints::operator=(NearestPoints&&) noexcept = default;

void NearestPoints::nearest(const std::array<float, 3>& query, int k, std::uint32_t* indices,
                            float* squared_distances) const {
  const std::size_t count = static_cast<std::size_t>(k);
  assert(k >= 1 && count <= tree_->points.points.size());
  if (k < 1) return;
  std::array<double, 64> few;
  std::vector<double> many(count > few.size() ? count : 0);
  double* distances = many.empty() ? few.data() : many.data();
  NearestSet set(indices, distances, count);
  const std::array<double, 3> at{query[0], query[1], query[2]};
  tree_->index.findNeighbors(set, at.data(), nanoflann::SearchParams());
  if (squared_distances == nullptr) return;
  for (std::size_t i = 0; i < count; ++i) squared_distances[i] = static_cast<float>(distances[i]);
}

}  // namespace slf
