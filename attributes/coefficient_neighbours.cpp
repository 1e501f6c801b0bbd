// SPDX-License-Identifier: Apache-2.0
#include "attributes/coefficient_neighbours.h"

#include <algorithm>

namespace slf {
namespace {

constexpr std::uint64_t kEveryThird = 0x1249249249249249u;  // Morton bits of x

/// The place of `cell` among the ascending cells before place `from`, or `from` where it is not
/// there. Neighbours are mostly near, so the steps back double.
std::size_t find_before(std::span<const std::uint64_t> cells, std::size_t from,
                        std::uint64_t cell) {
  std::size_t step = 1;
  while (step < from && cells[from - step] > cell) step *= 2;
  std::size_t first = from - std::min(step, from), count = from - step / 2 - first;
  while (count > 1) {  // without branches: what they would be is by chance
    const std::size_t half = count / 2;
    first += cells[first + half - 1] < cell ? half : 0;
    count -= half;
  }
  return count == 1 && cells[first] == cell ? first : from;
}

/// Scales of merges; most are of few points, and are worked out once.
class Scales {
 public:
  std::uint32_t of(std::uint64_t left, std::uint64_t right) {
    if (left >= kSmall || right >= kSmall) return compute(left, right);
    std::uint32_t& known = small_[left * kSmall + right];
    if (known == 0) known = compute(left, right);
    return known;
  }

 private:
  static constexpr std::size_t kSmall = 32;
  static std::uint32_t compute(std::uint64_t left, std::uint64_t right) {
    return static_cast<std::uint32_t>(isqrt((left * right << 16) / (left + right)));
  }
  std::array<std::uint32_t, kSmall * kSmall> small_{};
};

void set_scales(const RahtTree& tree, std::span<const std::uint32_t> first,
                const CodeWeights& weights, CoefficientNeighbours& around) {
  std::vector<std::uint32_t> weight(tree.size());
  for (std::size_t row = 0; row < tree.size(); ++row)
    weight[row] = weights.of(first[row], first[row + 1]);
  Scales scales;
  around.rows[0].scale = 256;
  for (std::size_t i = tree.merges.size(); i-- > 0;) {  // children before parents
    const Merge& m = tree.merges[i];
    around.rows[around.place[m.right]].scale = scales.of(weight[m.left], weight[m.right]);
    weight[m.left] += weight[m.right];
  }
}

CoefficientNeighbours rows_in_order(const RahtTree& tree) {
  CoefficientNeighbours around{std::vector<CoefficientNeighbours::Row>(tree.size()),
                               std::vector<std::uint32_t>(tree.size())};
  for (std::uint32_t i = 0; i < tree.size(); ++i) around.place[tree.order[i]] = i;
  for (std::size_t i = 0; i < tree.size(); ++i) {
    const std::uint32_t row = tree.order[i];
    around.rows[i].parent = around.place[tree.parent[row]];
    around.rows[i].split = tree.split[row];
  }
  return around;
}

}  // namespace

CoefficientNeighbours find_coefficient_neighbours(const RahtTree& tree,
                                                  std::span<const std::uint64_t> morton,
                                                  std::span<const std::uint32_t> first,
                                                  const CodeWeights& weights) {
  CoefficientNeighbours around = rows_in_order(tree);
  set_scales(tree, first, weights, around);
  std::vector<std::uint64_t> cells;  // of the merges of one split
  for (std::size_t begin = 1; begin < tree.size(); begin += cells.size()) {
    const std::uint32_t split = around.rows[begin].split;
    const std::uint64_t above = ~std::uint64_t{0} << split << 1;
    cells.clear();
    for (std::size_t i = begin; i < tree.size() && around.rows[i].split == split; ++i)
      cells.push_back(morton[first[tree.order[i]]] & above);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t along = kEveryThird << axis & above;
        if ((cells[i] & along) == 0) continue;  // at the border
        const std::uint64_t beside = (((cells[i] & along) - 1) & along) | (cells[i] & ~along);
        const std::size_t place = find_before(cells, i, beside);
        if (place < i)
          around.rows[begin + i].faces[axis] = static_cast<std::uint32_t>(begin + place);
      }
    }
  }
  return around;
}

}  // namespace slf
