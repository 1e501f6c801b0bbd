// SPDX-License-Identifier: Apache-2.0
#include "attributes/reference_coefficients.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "attributes/four_values.h"
#include "attributes/quantiser_step.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/weight_roots.h"
#include "base/multiversion.h"

namespace slf {
namespace {

/// The nodes of a level that have siblings.
struct Siblings {
  std::vector<std::uint64_t> codes;
  std::vector<std::uint32_t> weights;
  std::vector<std::uint8_t> there;   // has the reference all of it?
  std::vector<std::int32_t> values;  // [nodes][planes]
};

/// The mean of the reference at each node, times the root of the node's weight.
inline void node_values(const ReferenceTerms& terms, const std::int32_t* means,
                        const SmallRoots& roots, std::size_t planes, Siblings& nodes) {
  std::int32_t* value = nodes.values.data();
  for (std::size_t n = 0; n < nodes.codes.size(); ++n, value += planes) {
    const std::span<const ReferenceTerm> of_node = terms.of(n);
    nodes.there[n] = !of_node.empty();
    std::fill_n(value, planes, 0);
    for (const ReferenceTerm& term : of_node) {
      const std::int32_t* mean = means + term.node * planes;
      for (std::size_t j = 0; j < planes; ++j) value[j] += term.weight * mean[j];  // up to 2^29
    }
    const std::int32_t root_q19 = roots_of(roots, nodes.weights[n]).root_q19;
    for (std::size_t j = 0; j < planes; ++j)
      value[j] = rounded<19>(product(value[j] >> 12, root_q19));
  }
}

SLF_MULTIVERSION_LANES
void node_values_of_level(const ReferenceTerms& terms, const std::int32_t* means,
                          const SmallRoots& roots, std::size_t planes, Siblings& nodes) {
  if (planes == 3) return node_values(terms, means, roots, 3, nodes);  // one function
  node_values(terms, means, roots, planes, nodes);
}

inline std::uint8_t quarters(std::int32_t coefficient, const QuantiserStep& step) {
  const auto size = static_cast<std::uint64_t>(std::abs(std::int64_t{coefficient}));
  return static_cast<std::uint8_t>(
      std::min<std::uint64_t>(step.divide(4 * size), ReferenceCoefficients::kLargest));
}

/// Merges of a level, children before parents. place: [rows] of the nodes
inline void differences(std::span<const Merge> merges, std::span<const std::uint32_t> place,
                        std::span<const QuantiserStep> steps, std::size_t planes, Siblings& nodes,
                        ReferenceCoefficients& found) {
  for (std::size_t i = merges.size(); i-- > 0;) {
    const Merge m = merges[i];
    const std::size_t low = place[m.left], high = place[m.right];
    nodes.there[low] &= nodes.there[high];
    if (!nodes.there[low]) continue;
    std::int32_t* __restrict left = &nodes.values[low * planes];
    std::int32_t* __restrict right = &nodes.values[high * planes];
    for (std::size_t j = 0; j < planes; ++j) forward_merge(m, left[j], right[j]);
    std::uint8_t* to = found.row(m.right);
    for (std::size_t j = 0; j < planes; ++j) to[j] = quarters(right[j], steps[j]);
  }
}

SLF_MULTIVERSION_LANES
void differences_of_level(std::span<const Merge> merges, std::span<const std::uint32_t> place,
                          std::span<const QuantiserStep> steps, Siblings& nodes,
                          ReferenceCoefficients& found) {
  if (steps.size() == 3) return differences(merges, place, steps, 3, nodes, found);
  differences(merges, place, steps, steps.size(), nodes, found);
}

/// Goes up the levels, the finest first.
class Finder {
 public:
  Finder(const ReferenceRows& rows, const ReferenceMeans& reference,
         std::span<const std::uint32_t> steps)
      : rows_(rows),
        reference_(reference),
        steps_(steps.begin(), steps.end()),
        begins_(rows.tree.size()),
        place_(rows.tree.size()) {
    std::iota(begins_.begin(), begins_.end(), 0u);
  }

  /// merges: of level `level` - 1, which join nodes of `level`: one less than that of the call
  /// before, rows_.levels at the first.
  void find(std::span<const Merge> merges, int level, ReferenceCoefficients& found) {
    list_nodes(level);
    if (merges.empty()) return;
    const ReferenceTerms& terms =
        reference_.terms.of(reference_.moved, level, [this] { return nodes_.codes; });
    nodes_.there.resize(nodes_.codes.size());
    nodes_.values.resize(nodes_.codes.size() * steps_.size());
    node_values_of_level(terms, reference_.means[static_cast<std::size_t>(level)].data(),
                         small_roots(), steps_.size(), nodes_);
    differences_of_level(merges, place_, steps_, nodes_, found);
  }

 private:
  /// Nodes of the level that have siblings; rows that begin nodes of the level above stay.
  void list_nodes(int level) {
    nodes_.codes.clear();
    nodes_.weights.clear();
    const int lowest = 3 * (reference_.moved.bits - level);
    const std::size_t count = begins_.size();
    std::size_t above = 0;
    const auto begins_above = [&](std::size_t i) {
      return i == count || rows_.tree.split[begins_[i]] >= lowest + 3;
    };
    for (std::size_t i = 0; i < count; ++i) {
      const std::uint32_t row = begins_[i];
      const bool begins = begins_above(i);
      if (!begins || !begins_above(i + 1)) {
        const std::size_t end = i + 1 < count ? begins_[i + 1] : rows_.tree.size();
        place_[row] = static_cast<std::uint32_t>(nodes_.codes.size());
        nodes_.codes.push_back(rows_.codes[rows_.first[row]] >> lowest);
        nodes_.weights.push_back(rows_.first[end] - rows_.first[row]);
      }
      if (begins) begins_[above++] = row;
    }
    begins_.resize(above);
  }

  const ReferenceRows& rows_;
  const ReferenceMeans& reference_;
  std::vector<QuantiserStep> steps_;   // [planes]
  std::vector<std::uint32_t> begins_;  // rows of the nodes of the level at work, ascending
  std::vector<std::uint32_t> place_;   // [rows] of those in nodes_
  Siblings nodes_;
};

}  // namespace

ReferenceCoefficients find_reference_coefficients(const ReferenceRows& rows,
                                                  const ReferenceMeans& reference,
                                                  std::span<const std::uint32_t> steps) {
  ReferenceCoefficients found(rows.tree.size(), steps.size());
  Finder finder(rows, reference, steps);
  std::span<const Merge> merges = rows.tree.merges;
  const int bits = reference.moved.bits;
  const auto level_of = [&](const Merge& m) { return bits - rows.tree.split[m.right] / 3; };
  for (int level = rows.levels; level > 0; --level) {
    std::size_t begin = merges.size();
    while (begin > 0 && level_of(merges[begin - 1]) == level) --begin;
    finder.find(merges.subspan(begin), level, found);
    merges = merges.first(begin);
  }
  return found;
}

}  // namespace slf
