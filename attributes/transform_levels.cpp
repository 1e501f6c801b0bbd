// SPDX-License-Identifier: Apache-2.0
#include "attributes/transform_levels.h"

#include <algorithm>
#include <bit>

#include "geometry/morton.h"

namespace slf {

TransformLevels::TransformLevels(std::span<const std::uint64_t> morton, int depth, int dropped,
                                 int start, const CodeWeights& weights)
    : depth_(depth),
      dropped_(std::min(dropped, depth)),
      start_(start),
      level_(start - 1),
      weights_(weights) {
  std::array<std::int64_t, 3> sum{};
  for (std::size_t p = 0; p < morton.size(); ++p) {
    const std::uint64_t code = morton[p] >> (3 * dropped_);
    if (codes_.empty() || code != codes_.back()) {
      codes_.push_back(code);
      first_.push_back(static_cast<std::uint32_t>(p));
      sums_.push_back(sum);
    }
    const Voxel v = from_morton(morton[p]);
    for (std::size_t a = 0; a < 3; ++a) sum[a] += v[a];
  }
  first_.push_back(static_cast<std::uint32_t>(morton.size()));
  sums_.push_back(sum);
  begins_.resize(codes_.size());
  for (std::size_t row = 1; row < codes_.size(); ++row) {
    const auto differs = static_cast<int>(std::bit_width(codes_[row] ^ codes_[row - 1]));
    begins_[row] = static_cast<std::uint8_t>(std::max(count() - (differs - 1) / 3, 0));
  }
}

const TransformLevel& TransformLevels::next() {
  ++level_;
  if (level_ == start_) {
    current_.rows = rows_of(0);
    current_.nodes = octree_level(cells_of(current_.rows), start_);
  } else {
    current_.nodes = octree_children(current_.nodes, true, current_.child_rows);
    current_.rows = std::move(current_.child_rows);
  }
  current_.child_rows = rows_of(level_ - start_ + 1);
  current_.places = places_of(current_.rows);
  current_.child_places = places_of(current_.child_rows);
  OctreeLevel& nodes = current_.nodes;
  const int below = 3 * (depth_ - dropped_ - level_ - 1);
  std::uint32_t child = 0;
  nodes.first_child.resize(nodes.size());
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    nodes.first_child[n] = child;
    for (; current_.child_rows[child] < current_.rows[n + 1]; ++child)
      nodes.occupancy[n] = static_cast<std::uint8_t>(
          nodes.occupancy[n] | 1u << (codes_[current_.child_rows[child]] >> below & 7));
  }
  mark_means();
  if (reference_ != nullptr) find_reference();
  return current_;
}

/// Branching nodes and their neighbours: fewer than 27 per merge, however deep the tree.
void TransformLevels::mark_means() {
  constexpr std::uint32_t kNone = 0xFFFFFFFFu;
  const OctreeLevel& nodes = current_.nodes;
  const auto for_each_needed = [&](std::uint32_t n, const auto& body) {
    if (!current_.branches(n)) return;
    for (const std::uint32_t neighbour : nodes.neighbours_of(n)) body(neighbour);
    body(n);
  };
  const auto count = static_cast<std::uint32_t>(nodes.size());
  std::vector<std::uint32_t> last(count), free;  // node that needs a mean last; slots to use again
  for (std::uint32_t n = 0; n < count; ++n)
    for_each_needed(n, [&](std::uint32_t m) { last[m] = n; });
  current_.means.clear();
  current_.means_end.resize(count);
  current_.slot.assign(count, kNone);
  current_.num_slots = 0;
  for (std::uint32_t n = 0; n < count; ++n) {
    for_each_needed(n, [&](std::uint32_t m) {
      if (current_.slot[m] != kNone) return;
      current_.means.push_back(m);
      if (free.empty()) free.push_back(current_.num_slots++);
      current_.slot[m] = free.back();
      free.pop_back();
    });
    current_.means_end[n] = static_cast<std::uint32_t>(current_.means.size());
    for_each_needed(n, [&](std::uint32_t m) {
      if (last[m] == n) free.push_back(current_.slot[m]);
    });
  }
}

/// TransformLevel::rows of a level, counted from `start`.
std::vector<std::uint32_t> TransformLevels::rows_of(int level) const {
  std::vector<std::uint32_t> rows(begins_.size() + 1);
  std::size_t count = 0;
  for (std::size_t row = 0; row < begins_.size(); ++row) {
    rows[count] = static_cast<std::uint32_t>(row);
    count += begins_[row] <= level;
  }
  rows[count++] = static_cast<std::uint32_t>(begins_.size());
  rows.resize(count);
  return rows;
}

void TransformLevels::find_reference() {
  const OctreeLevel& nodes = current_.nodes;
  current_.reference =
      &reference_->terms.of(reference_->moved, level_ + 1, [this] { return cells_of_siblings(); });
  current_.first_term.resize(nodes.size());
  std::uint32_t place = 0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    current_.first_term[n] = place;
    if (current_.branches(n)) place += static_cast<std::uint32_t>(children_of(n));
  }
}

std::size_t TransformLevels::children_of(std::size_t n) const {
  return static_cast<std::size_t>(std::popcount(current_.nodes.occupancy[n]));
}

/// Codes of the nodes of the level below that have siblings.
std::vector<std::uint64_t> TransformLevels::cells_of_siblings() const {
  const OctreeLevel& nodes = current_.nodes;
  const int below = 3 * (depth_ - dropped_ - level_ - 1);
  std::vector<std::uint64_t> cells;
  cells.reserve(current_.child_rows.size() - 1);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const std::size_t first = nodes.first_child[n];
    for (std::size_t c = 0; current_.branches(n) && c < children_of(n); ++c)
      cells.push_back(codes_[current_.child_rows[first + c]] >> below);
  }
  return cells;
}

/// Codes of the nodes of level `start`.
std::vector<std::uint64_t> TransformLevels::cells_of(const std::vector<std::uint32_t>& rows) const {
  std::vector<std::uint64_t> cells(rows.size() - 1);
  for (std::size_t n = 0; n < cells.size(); ++n) cells[n] = codes_[rows[n]] >> (3 * count());
  return cells;
}

std::vector<NodePlace> TransformLevels::places_of(const std::vector<std::uint32_t>& rows) const {
  const int side_log2 = depth_ - level_ - 1;
  std::vector<NodePlace> places(rows.size() - 1);
  for (std::size_t n = 0; n < places.size(); ++n) {
    const std::uint32_t row = rows[n], end = rows[n + 1];
    NodePlace& place = places[n];
    const std::uint32_t codes = first_[end] - first_[row];
    place.weight = weights_.of(first_[row], first_[end]);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::int64_t sum = (sums_[end][a] - sums_[row][a]) << 4;
      place.centre[a] = static_cast<std::int32_t>(
          codes == 1 ? sum >> side_log2 : sum / (std::int64_t{codes} << side_log2));
    }
  }
  return places;
}

}  // namespace slf
