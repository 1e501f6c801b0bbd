// SPDX-License-Identifier: Apache-2.0
// The cells of the base that a slice consists of, and what its transform starts from: values and
// contexts of the base. Spec 8.6.4, 8.7.2.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"

namespace slf {

/// Cells of a slice, in Morton order, as rows of its tree.
struct SliceCells {
  std::size_t first = 0;              ///< the slice's first cell among those of the scene
  std::vector<std::uint32_t> row;     ///< [cells] first row of each
  std::vector<std::uint32_t> weight;  ///< [cells] points of each, 1 .. 2^22

  std::size_t size() const { return row.size(); }
};

/// @param first_point   [rows + 1] first point of each row of the tree, and the number of points
/// @param lowest_split  of what joins cells: 3 (grid_bits - B)
/// @param first_cell    the slice's first cell among those of the scene
/// O(rows).
SliceCells find_cells(const RahtTree& tree, std::span<const std::uint32_t> first_point,
                      int lowest_split, std::size_t first_cell);

/// The weight of a node changes: its value, mean * sqrt(weight), with it. Spec 8.6.4.
class WeightChange {
 public:
  /// from, to: 1 .. 2^22.
  WeightChange(std::uint32_t from, std::uint32_t to);

  /// value * sqrt(to / from), to nearest, ties away from zero, within 2^29 either way.
  std::int32_t operator()(std::int32_t value) const;

 private:
  std::int64_t root_q20_;  // at most 2^31
};

/// Values of the base's rows to those of a slice's cells, whose rows are overwritten.
/// @param base    [cells of the scene][planes] what the transform of the base leaves
/// @param weights  of the cells of the base
/// @param values  [rows][planes] of the slice
void start_from_base(const SliceCells& cells, std::span<const std::int32_t> base,
                     const CodeWeights& weights, std::size_t planes,
                     std::span<std::int32_t> values);

/// The way back, for an encoder: what raht_forward leaves in the rows of the cells (sum / sqrt(w)),
/// to the base's input, rows cells.first .. of it.
void put_into_base(const SliceCells& cells, std::span<const std::int32_t> values,
                   const CodeWeights& weights, std::size_t planes, std::span<std::int32_t> base);

}  // namespace slf
