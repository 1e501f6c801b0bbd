// SPDX-License-Identifier: Apache-2.0
#include "attributes/raht_tree.h"

#include <array>
#include <bit>
#include <utility>

namespace slf {
namespace {

constexpr std::uint32_t kLeaf = 0xFFFFFFFFu;
constexpr int kSplits = 64;

/// Rows joined below each row's merge on either side; the tree is the Cartesian tree of the splits.
struct Children {
  std::vector<std::uint32_t> left, right;  ///< [P] row of the merge, kLeaf for a point
  std::uint32_t root = kLeaf;
};

Children cartesian_tree(const std::vector<std::uint8_t>& split) {
  const std::size_t count = split.size();
  Children tree{std::vector<std::uint32_t>(count, kLeaf), std::vector<std::uint32_t>(count, kLeaf),
                kLeaf};
  std::vector<std::uint32_t> spine;  // rows whose right side is still open, splits descending
  for (std::uint32_t row = 1; row < count; ++row) {
    std::uint32_t below = kLeaf;
    while (!spine.empty() && split[spine.back()] < split[row]) {
      below = spine.back();
      spine.pop_back();
    }
    tree.left[row] = below;
    if (!spine.empty()) tree.right[spine.back()] = row;
    spine.push_back(row);
  }
  if (!spine.empty()) tree.root = spine.front();
  return tree;
}

/// Spec 8.6.2: sqrt(part / whole) with 30 fractional bits, part < whole <= 2^24.
std::int32_t root_of_share(std::uint64_t part, std::uint64_t whole) {
  return static_cast<std::int32_t>(isqrt(((part << 40) / whole) << 20));
}

/// Cosine and sine of merges; most are of few points, and are worked out once.
class Shares {
 public:
  std::array<std::int32_t, 2> of(std::uint64_t left, std::uint64_t right) {
    if (left >= kSmall || right >= kSmall) return compute(left, right);
    auto& known = small_[left * kSmall + right];
    if (known[0] == 0) known = compute(left, right);
    return known;
  }

 private:
  static constexpr std::size_t kSmall = 32;
  static std::array<std::int32_t, 2> compute(std::uint64_t left, std::uint64_t right) {
    return {root_of_share(left, left + right), root_of_share(right, left + right)};
  }
  std::array<std::array<std::int32_t, 2>, kSmall * kSmall> small_{};
};

/// Rows by split descending, ascending within: a counting sort.
std::vector<std::uint32_t> coding_order(const std::vector<std::uint8_t>& split) {
  std::array<std::uint32_t, kSplits + 1> begin{};
  for (std::size_t row = 1; row < split.size(); ++row) ++begin[kSplits - 1u - split[row] + 1u];
  begin[0] = 1;  // row 0 comes first
  for (std::size_t i = 1; i <= kSplits; ++i) begin[i] += begin[i - 1];
  std::vector<std::uint32_t> order(split.size(), 0);
  for (std::uint32_t row = 1; row < split.size(); ++row)
    order[begin[kSplits - 1u - split[row]]++] = row;
  return order;
}

/// Level of a merge, coarsest first.
std::size_t level_of(int split) { return static_cast<std::size_t>(kSplits / 3 - split / 3); }

/// Place of the first merge of each level, where merges are by level.
std::array<std::size_t, kSplits / 3 + 2> level_begins(const std::vector<std::uint8_t>& split) {
  std::array<std::size_t, kSplits / 3 + 2> begin{};
  for (std::size_t row = 1; row < split.size(); ++row) ++begin[level_of(split[row]) + 1];
  for (std::size_t l = 1; l < begin.size(); ++l) begin[l] += begin[l - 1];
  return begin;
}

/// Merges with their weights, by level and otherwise from the top down; fills in the parents too.
void add_merges(RahtTree& tree, std::span<const std::uint32_t> first, const CodeWeights& weights) {
  const auto count = static_cast<std::uint32_t>(tree.size());
  const Children children = cartesian_tree(tree.split);
  auto place = level_begins(tree.split);
  tree.merges.resize(count - 1);
  struct Open {
    std::uint32_t merge, first, end;  // the merge's row; the rows it joins
  };
  std::vector<Open> open;
  Shares shares;
  if (children.root != kLeaf) open.push_back({children.root, 0, count});
  while (!open.empty()) {
    const Open node = open.back();
    open.pop_back();
    const auto weight = [&](std::uint32_t begin, std::uint32_t end) {
      return first.empty() ? weights.of(begin, end) : weights.of(first[begin], first[end]);
    };
    const auto [cosine, sine] =
        shares.of(weight(node.first, node.merge), weight(node.merge, node.end));
    tree.merges[place[level_of(tree.split[node.merge])]++] = {node.first, node.merge, cosine, sine};
    if (const std::uint32_t below = children.right[node.merge]; below != kLeaf) {
      tree.parent[below] = node.merge;
      open.push_back({below, node.merge, node.end});
    }
    if (const std::uint32_t below = children.left[node.merge]; below != kLeaf) {
      tree.parent[below] = node.merge;
      open.push_back({below, node.first, node.merge});
    }
  }
}

/// first: [rows + 1] first code of each row; empty: every row is one.
RahtTree build_tree(std::vector<std::uint8_t> split, std::span<const std::uint32_t> first,
                    const CodeWeights& weights) {
  RahtTree tree;
  tree.split = std::move(split);
  tree.parent.assign(tree.size(), 0);
  tree.order = coding_order(tree.split);
  add_merges(tree, first, weights);
  return tree;
}

}  // namespace

RahtTree build_raht_tree(std::span<const std::uint64_t> morton, const CodeWeights& weights) {
  std::vector<std::uint8_t> split(morton.size(), 255);
  for (std::size_t row = 1; row < morton.size(); ++row)
    split[row] = static_cast<std::uint8_t>(std::bit_width(morton[row] ^ morton[row - 1]) - 1);
  return build_tree(std::move(split), {}, weights);
}

RahtTop build_raht_top(std::span<const std::uint64_t> morton, int lowest_split,
                       const CodeWeights& weights) {
  RahtTop top;
  std::vector<std::uint8_t> split;
  for (std::size_t p = 0; p < morton.size(); ++p) {
    const int bit = p == 0 ? 255 : static_cast<int>(std::bit_width(morton[p] ^ morton[p - 1])) - 1;
    if (bit < lowest_split) continue;
    split.push_back(static_cast<std::uint8_t>(bit));
    top.first.push_back(static_cast<std::uint32_t>(p));
  }
  top.first.push_back(static_cast<std::uint32_t>(morton.size()));
  top.tree = build_tree(std::move(split), top.first, weights);
  return top;
}

std::size_t order_end(const RahtTree& tree, int bit) {
  std::size_t begin = 1, end = tree.size();
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (static_cast<int>(tree.split[tree.order[middle]]) >= bit) {
      begin = middle + 1;
    } else {
      end = middle;
    }
  }
  return begin;
}

}  // namespace slf
