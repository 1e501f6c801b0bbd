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
  const auto begin = cells.begin() + static_cast<std::ptrdiff_t>(from - std::min(step, from));
  const auto end = cells.begin() + static_cast<std::ptrdiff_t>(from - step / 2);
  const auto found = std::lower_bound(begin, end, cell);
  return found != end && *found == cell ? static_cast<std::size_t>(found - cells.begin()) : from;
}

std::vector<std::uint32_t> coefficient_scales(const RahtTree& tree,
                                              std::span<const std::uint32_t> first) {
  std::vector<std::uint32_t> scale(tree.size(), 256), points(tree.size());
  for (std::size_t row = 0; row < tree.size(); ++row) points[row] = first[row + 1] - first[row];
  for (std::size_t i = tree.merges.size(); i-- > 0;) {  // children before parents
    const Merge& m = tree.merges[i];
    const std::uint64_t left = points[m.left], right = points[m.right];
    scale[m.right] = static_cast<std::uint32_t>(isqrt((left * right << 16) / (left + right)));
    points[m.left] += points[m.right];
  }
  return scale;
}

}  // namespace

CoefficientNeighbours find_coefficient_neighbours(const RahtTree& tree,
                                                  std::span<const std::uint64_t> morton,
                                                  std::span<const std::uint32_t> first) {
  CoefficientNeighbours around{std::vector<std::array<std::uint32_t, 3>>(tree.size()),
                               coefficient_scales(tree, first)};
  std::vector<std::uint64_t> cells;  // of the merges of one split
  for (std::size_t begin = 1; begin < tree.size(); begin += cells.size()) {
    const int split = tree.split[tree.order[begin]];
    const std::uint64_t above = ~std::uint64_t{0} << split << 1;
    cells.clear();
    for (std::size_t i = begin; i < tree.size() && tree.split[tree.order[i]] == split; ++i)
      cells.push_back(morton[first[tree.order[i]]] & above);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::uint64_t along = kEveryThird << axis & above;
        if ((cells[i] & along) == 0) continue;  // at the border
        const std::uint64_t beside = (((cells[i] & along) - 1) & along) | (cells[i] & ~along);
        const std::size_t place = find_before(cells, i, beside);
        if (place < i) around.faces[tree.order[begin + i]][axis] = tree.order[begin + place];
      }
    }
  }
  return around;
}

}  // namespace slf
