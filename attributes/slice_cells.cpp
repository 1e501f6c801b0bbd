// SPDX-License-Identifier: Apache-2.0
#include "attributes/slice_cells.h"

#include <algorithm>

namespace slf {
namespace {

constexpr std::int64_t kValueLimit = std::int64_t{1} << 29;

}  // namespace

SliceCells find_cells(const RahtTree& tree, std::span<const std::uint32_t> first_point,
                      int lowest_split, std::size_t first_cell) {
  SliceCells cells{first_cell, {}, {}};
  std::uint32_t begin = 0;  // first point of the last cell
  for (std::uint32_t row = 0; row < tree.size(); ++row) {
    if (row > 0 && static_cast<int>(tree.split[row]) < lowest_split) continue;
    if (row > 0) cells.weight.push_back(first_point[row] - begin);
    cells.row.push_back(row);
    begin = first_point[row];
  }
  cells.weight.push_back(first_point[tree.size()] - begin);
  return cells;
}

WeightChange::WeightChange(std::uint32_t from, std::uint32_t to)
    : root_q20_(static_cast<std::int64_t>(isqrt((std::uint64_t{to} << 40) / from))) {}

std::int32_t WeightChange::operator()(std::int32_t value) const {
  // At most 2^31 * 2^31, of which the rounding is a shift of non-negative numbers or of negative
  // ones towards minus infinity.
  const std::int64_t rounded = (value * root_q20_ + (1 << 19) - (value < 0)) >> 20;
  return static_cast<std::int32_t>(std::clamp(rounded, -kValueLimit, kValueLimit));
}

void start_from_base(const SliceCells& cells, std::span<const std::int32_t> base,
                     const CodeWeights& weights, std::size_t planes,
                     std::span<std::int32_t> values) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const WeightChange change(weights.of(cells.first + i), cells.weight[i]);
    const auto from = base.subspan((cells.first + i) * planes, planes);
    std::transform(from.begin(), from.end(),
                   values.begin() + static_cast<std::ptrdiff_t>(cells.row[i] * planes), change);
  }
}

void put_into_base(const SliceCells& cells, std::span<const std::int32_t> values,
                   const CodeWeights& weights, std::size_t planes, std::span<std::int32_t> base) {
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const WeightChange change(cells.weight[i], weights.of(cells.first + i));
    const auto from = values.subspan(cells.row[i] * planes, planes);
    std::transform(from.begin(), from.end(),
                   base.begin() + static_cast<std::ptrdiff_t>((cells.first + i) * planes), change);
  }
}

}  // namespace slf
