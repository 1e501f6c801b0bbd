// SPDX-License-Identifier: Apache-2.0
#include "codec/encoder/scene_layout.h"

#include <algorithm>

#include "base/input_error.h"
#include "geometry/weight_classes.h"

namespace slf {
namespace {

constexpr std::size_t kFewPoints = 2000;   // a base does not pay below
constexpr std::size_t kPointsOfCell = 24;  // at least, by choice: docs/decisions/005
constexpr std::size_t kCellsOfSlice = 2;   // at least, where there are several slices
/// At least, of slices apart: enough to cut slices alike, and few, since no cell knows of another.
constexpr std::size_t kCellsOfSliceApart = 4;

/// [levels + 1] nodes at each level.
std::vector<std::size_t> count_nodes(std::span<const std::uint64_t> morton, int bits) {
  std::vector<std::size_t> nodes(static_cast<std::size_t>(bits) + 1, 1);
  for (std::size_t p = 1; p < morton.size(); ++p)
    for (int level = bits; level > 0; --level) {
      const int below = 3 * (bits - level);
      if (morton[p] >> below == morton[p - 1] >> below) break;
      ++nodes[static_cast<std::size_t>(level)];
    }
  return nodes;
}

bool one_unit_for_all(const CodingParameters& p) {
  return p.geometry == GeometryCoder::kDraco || p.coefficients == CoefficientCoder::kTexture;
}

std::size_t wanted_slices(std::size_t points, const CodingParameters& p) {
  if (one_unit_for_all(p) || p.base_levels == 0) return 1;
  const std::size_t most = p.max_slice_points;
  const std::size_t rounded = (points + most / 2) / most;
  return std::max({std::size_t{1}, rounded, (points + kMaxSlicePoints - 1) / kMaxSlicePoints});
}

/// First point of each cell, and the number of points.
std::vector<std::size_t> find_layout_cells(std::span<const std::uint64_t> morton, int below,
                                           std::vector<std::uint64_t>& cells) {
  std::vector<std::size_t> first;
  for (std::size_t p = 0; p < morton.size(); ++p) {
    const std::uint64_t cell = below < 63 ? morton[p] >> below : 0;
    if (!cells.empty() && cells.back() == cell) continue;
    cells.push_back(cell);
    first.push_back(p);
  }
  first.push_back(morton.size());
  return first;
}

/// The deepest level whose cells are large enough, and enough for the slices.
int choose_base_levels(const std::vector<std::size_t>& nodes, std::size_t slices,
                       const CodingParameters& p) {
  const std::size_t points = nodes.back();
  if (one_unit_for_all(p) || (slices == 1 && points < kFewPoints)) return 0;
  const int most = static_cast<int>(nodes.size()) - 2;
  int level = std::min(1, most);
  const auto at = [&](int l) { return nodes[static_cast<std::size_t>(l)]; };
  const bool apart = slices > 1 && p.slice_start == SliceStart::kApart;
  while (level < most && at(level + 1) * kPointsOfCell <= points &&
         !(apart && at(level) >= kCellsOfSliceApart * slices))
    ++level;
  while (slices > 1 && level < most && at(level) < kCellsOfSlice * slices) ++level;
  return level;
}

/// Runs of cells of about as many points, each at least one cell.
std::vector<SliceCut> cut_runs(const std::vector<std::size_t>& first, std::size_t slices) {
  const std::size_t cells = first.size() - 1, points = first.back();
  std::vector<SliceCut> cuts;
  std::size_t cell = 0;
  for (std::size_t s = 0; s < slices; ++s) {
    const std::size_t target = points * (s + 1) / slices, most = cells - (slices - 1 - s);
    std::size_t end = cell + 1;
    while (end < most && first[end] < target) ++end;
    if (end > cell + 1 && first[end] - target > target - std::min(target, first[end - 1])) --end;
    if (s + 1 == slices) end = cells;
    cuts.push_back({cell, first[cell], first[end]});
    cell = end;
  }
  return cuts;
}

Result<Done, InputError> describe_slices(SceneLayout& layout) {
  layout.table.slices_num_minus1 = static_cast<std::uint32_t>(layout.cuts.size() - 1);
  for (std::size_t s = 0; s < layout.cuts.size(); ++s) {
    const SliceCut& cut = layout.cuts[s];
    const std::size_t end =
        s + 1 < layout.cuts.size() ? layout.cuts[s + 1].first_cell : layout.cells.size();
    if (cut.end - cut.begin > kMaxSlicePoints)
      return invalid_argument(
          "points per slice: more than 2^22 in one slice; a base of more levels may do");
    layout.table.slices.push_back({static_cast<std::uint32_t>(end - cut.first_cell - 1),
                                   static_cast<std::uint32_t>(cut.end - cut.begin - 1)});
  }
  return Done{};
}

/// What cells count as, by their points, or all alike; smaller by a power of two where together
/// they would be too heavy.
std::vector<std::uint8_t> classes_of(const std::vector<std::size_t>& first, std::uint32_t alike) {
  std::vector<std::uint8_t> classes(first.size() - 1);
  for (int smaller = 0;; ++smaller) {
    std::uint64_t weight = 0;
    for (std::size_t i = 0; i < classes.size(); ++i) {
      const int k = weight_class(
          std::min<std::uint64_t>(alike > 0 ? alike : first[i + 1] - first[i], kMaxSlicePoints));
      classes[i] = static_cast<std::uint8_t>(std::max(k - smaller, 0));
      weight += std::uint64_t{1} << classes[i];
    }
    if (weight <= kMostBaseWeight) return classes;
  }
}

Result<int, InputError> levels_of_base(const std::vector<std::size_t>& nodes, std::size_t slices,
                                       const CodingParameters& p) {
  if (p.base_levels < 0) return choose_base_levels(nodes, slices, p);
  if (p.base_levels > 0 && one_unit_for_all(p))
    return invalid_argument("base levels: 0 for Draco and for textures");
  if (p.base_levels > static_cast<int>(nodes.size()) - 2)
    return invalid_argument("base levels: fewer than the grid's bits");
  if (nodes[static_cast<std::size_t>(p.base_levels)] > kMaxCells)
    return invalid_argument("base levels: more than 2^22 cells");
  return p.base_levels;
}

}  // namespace

Result<SceneLayout, InputError> lay_out(std::span<const std::uint64_t> morton, int grid_bits,
                                        const CodingParameters& parameters) {
  const std::vector<std::size_t> nodes = count_nodes(morton, grid_bits);
  std::size_t slices = wanted_slices(morton.size(), parameters);
  SceneLayout layout;
  SLF_TRY(layout.base_levels, levels_of_base(nodes, slices, parameters));
  const std::vector<std::size_t> first =
      find_layout_cells(morton, 3 * (grid_bits - layout.base_levels), layout.cells);
  const std::size_t cells = layout.cells.size();
  if (layout.base_levels == 0) slices = 1;
  slices = std::min({slices, cells, std::size_t{kMaxSlices}});
  layout.cuts = cut_runs(first, slices);
  if (layout.base_levels > 0) {
    layout.classes = classes_of(first, parameters.base_weight);
    layout.weight_before = weights_before(layout.classes);
  }
  if (slices > 1) layout.table.slices_start = static_cast<std::uint32_t>(parameters.slice_start);
  SLF_CHECK(describe_slices(layout));
  return layout;
}

}  // namespace slf
