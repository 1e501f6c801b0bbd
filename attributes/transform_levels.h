// SPDX-License-Identifier: Apache-2.0
// The octree levels of a transform tree: which rows are nodes, and where they lie. Spec 8.7.6.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/code_weights.h"
#include "attributes/reference_means.h"
#include "geometry/octree_levels.h"

namespace slf {

/// Where the points of a node are.
struct NodePlace {
  std::array<std::int32_t, 3> centre;  ///< mean position, in sixteenths of the side of a child
  std::uint32_t weight;                ///< of its points, or cells of a base
};

/// A level and the level below it. A node's row is that of its first point.
struct TransformLevel {
  OctreeLevel nodes;                      ///< the level's nodes, with neighbours
  std::vector<std::uint32_t> rows;        ///< [nodes + 1] row of each, and the number of rows
  std::vector<std::uint32_t> child_rows;  ///< [children + 1] the same of the level below
  std::vector<NodePlace> places, child_places;
  /// Nodes whose mean a prediction needs, in the order in which nodes 0, 1, .. first need them.
  std::vector<std::uint32_t> means;
  std::vector<std::uint32_t> means_end;  ///< [nodes] of `means`, those that nodes 0 .. n need
  /// [nodes] where its mean is kept until the last node that needs it; undefined for others.
  std::vector<std::uint32_t> slot;
  /// Terms of children that have siblings, in a frame that is predicted; else nullptr.
  const ReferenceTerms* reference = nullptr;
  std::vector<std::uint32_t> first_term;  ///< [nodes] place in it of a node's first child
  std::uint32_t num_slots = 0;  ///< far fewer than means: what is needed at a time fits a cache

  /// A node of one child has no merge, and nothing of it is predicted.
  bool branches(std::size_t n) const {
    return (nodes.occupancy[n] & (nodes.occupancy[n] - 1)) != 0;
  }
};

/// Goes down the levels, O(rows) each.
class TransformLevels {
 public:
  /// morton: of all points of the slice, ascending, of `depth` levels; the rows are the nodes of
  /// the first depth - dropped levels (RahtTop), at least the root.
  /// @param start   the first level: that of a slice's cells, 0 without a base, at most depth -
  ///                dropped
  /// @param weights  of the codes; they move no centre
  TransformLevels(std::span<const std::uint64_t> morton, int depth, int dropped, int start = 0,
                  const CodeWeights& weights = {});

  /// Before the first level of a frame that is predicted; kept by pointer.
  void predict_from(const ReferenceMeans& reference) { reference_ = &reference; }
  /// Levels from `start` on.
  int count() const { return depth_ - dropped_ - start_; }
  std::size_t rows() const { return codes_.size(); }
  std::size_t points() const { return first_.back(); }
  /// Begins with level `start`; called count() times.
  const TransformLevel& next();

 private:
  void mark_means();
  std::vector<std::uint32_t> rows_of(int level) const;
  std::vector<std::uint64_t> cells_of(const std::vector<std::uint32_t>& rows) const;
  void find_reference();
  std::size_t children_of(std::size_t n) const;
  std::vector<std::uint64_t> cells_of_siblings() const;
  std::vector<NodePlace> places_of(const std::vector<std::uint32_t>& rows) const;

  const ReferenceMeans* reference_ = nullptr;
  int depth_, dropped_, start_, level_;
  CodeWeights weights_;
  std::vector<std::uint64_t> codes_;               // [rows] on the grid of the kept levels
  std::vector<std::uint32_t> first_;               // [rows + 1] first point
  std::vector<std::array<std::int64_t, 3>> sums_;  // [rows + 1] of the positions of points before
  std::vector<std::uint8_t> begins_;               // [rows] first level, from `start` on, where
                                                   // the row is a node of its own
  TransformLevel current_;
};

}  // namespace slf
