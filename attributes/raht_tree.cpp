#include "attributes/raht_tree.h"

#include <array>
#include <bit>
#include <numeric>
#include <utility>

namespace slf {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFFu;
constexpr int kSplits = 64;

/// Rows joined below each row's merge on either side; the tree is the Cartesian tree of the splits.
struct Children {
  std::vector<std::uint32_t> left, right;  ///< [P] row of the merge, kNone for a point
  std::uint32_t root = kNone;
};

Children cartesian_tree(const std::vector<std::uint8_t>& split) {
  const std::size_t count = split.size();
  Children tree{std::vector<std::uint32_t>(count, kNone), std::vector<std::uint32_t>(count, kNone),
                kNone};
  std::vector<std::uint32_t> spine;  // rows whose right side is still open, splits descending
  for (std::uint32_t row = 1; row < count; ++row) {
    std::uint32_t below = kNone;
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

/// Spec 8.6.2: sqrt(part / whole) with 30 fractional bits, part < whole <= 2^22.
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

/// Merges by octree level, coarsest first, otherwise in their order.
std::vector<Merge> by_level(const std::vector<Merge>& merges,
                            const std::vector<std::uint8_t>& split) {
  std::array<std::size_t, kSplits / 3 + 2> begin{};
  const auto level = [&](const Merge& m) { return kSplits / 3u - split[m.right] / 3u; };
  for (const Merge& m : merges) ++begin[level(m) + 1];
  for (std::size_t l = 1; l < begin.size(); ++l) begin[l] += begin[l - 1];
  std::vector<Merge> sorted(merges.size());
  for (const Merge& m : merges) sorted[begin[level(m)]++] = m;
  return sorted;
}

}  // namespace

RahtTree build_raht_tree(std::span<const std::uint64_t> morton) {
  const std::size_t count = morton.size();
  RahtTree tree;
  tree.split.assign(count, 255);
  for (std::size_t row = 1; row < count; ++row)
    tree.split[row] = static_cast<std::uint8_t>(std::bit_width(morton[row] ^ morton[row - 1]) - 1);
  tree.parent.assign(count, 0);
  tree.order = coding_order(tree.split);
  tree.merges.reserve(count - 1);

  const Children children = cartesian_tree(tree.split);
  struct Open {
    std::uint32_t merge, first, end;  // the merge's row; the points it joins
  };
  std::vector<Open> open;
  Shares shares;
  if (children.root != kNone) open.push_back({children.root, 0, static_cast<std::uint32_t>(count)});
  while (!open.empty()) {
    const Open node = open.back();
    open.pop_back();
    const std::uint64_t left = node.merge - node.first, right = node.end - node.merge;
    const auto [cosine, sine] = shares.of(left, right);
    tree.merges.push_back({node.first, node.merge, cosine, sine});
    if (const std::uint32_t below = children.right[node.merge]; below != kNone) {
      tree.parent[below] = node.merge;
      open.push_back({below, node.merge, node.end});
    }
    if (const std::uint32_t below = children.left[node.merge]; below != kNone) {
      tree.parent[below] = node.merge;
      open.push_back({below, node.first, node.merge});
    }
  }
  tree.merges = by_level(tree.merges, tree.split);
  return tree;
}

RahtTop cut_raht_tree(RahtTree tree, int lowest_split) {
  RahtTop top;
  if (lowest_split == 0) {
    top.first.resize(tree.size() + 1);
    std::iota(top.first.begin(), top.first.end(), 0u);
    top.tree = std::move(tree);
    return top;
  }
  std::vector<std::uint32_t> kept(tree.size(), kNone);  // new number of each row
  const auto stays = [&](std::uint32_t row) { return row == 0 || tree.split[row] >= lowest_split; };
  for (std::uint32_t row = 0; row < tree.size(); ++row) {
    if (!stays(row)) continue;
    kept[row] = static_cast<std::uint32_t>(top.first.size());
    top.first.push_back(row);
    top.tree.split.push_back(tree.split[row]);
    // A parent's split is higher, so it stays too; it may be numbered later.
    top.tree.parent.push_back(tree.parent[row]);
  }
  top.first.push_back(static_cast<std::uint32_t>(tree.size()));
  for (auto& parent : top.tree.parent) parent = kept[parent];
  for (const Merge& m : tree.merges)
    if (stays(m.right))
      top.tree.merges.push_back({kept[m.left], kept[m.right], m.cos_q30, m.sin_q30});
  for (const std::uint32_t row : tree.order)
    if (stays(row)) top.tree.order.push_back(kept[row]);
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
