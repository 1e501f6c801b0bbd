// SPDX-License-Identifier: Apache-2.0
#include "attributes/reference_coefficients.h"

#include <algorithm>
#include <cstdlib>

#include "attributes/four_values.h"
#include "attributes/quantiser_step.h"
#include "attributes/raht_arithmetic.h"
#include "attributes/weight_roots.h"
#include "base/multiversion.h"

namespace slf {
namespace {

/// The mean of the reference at a node, times the root of the node's weight.
SLF_MULTIVERSION
void node_value(std::span<const ReferenceTerm> terms, const std::int32_t* means,
                std::int32_t root_q19, std::size_t planes, std::int32_t* value) {
  std::fill_n(value, planes, 0);
  for (const ReferenceTerm& term : terms) {
    const std::int32_t* mean = means + term.node * planes;
    for (std::size_t j = 0; j < planes; ++j) value[j] += term.weight * mean[j];  // up to 2^29
  }
  for (std::size_t j = 0; j < planes; ++j)
    value[j] = rounded<19>(product(value[j] >> 12, root_q19));
}

SLF_MULTIVERSION
void forward_rows(const Merge& m, std::int32_t* __restrict left, std::int32_t* __restrict right,
                  std::size_t planes) {
  for (std::size_t j = 0; j < planes; ++j) forward_merge(m, left[j], right[j]);
}

std::uint8_t quarters(std::int32_t coefficient, const QuantiserStep& step) {
  const auto size = static_cast<std::uint64_t>(std::abs(std::int64_t{coefficient}));
  return static_cast<std::uint8_t>(
      std::min<std::uint64_t>(step.divide(4 * size), ReferenceCoefficients::kLargest));
}

class Finder {
 public:
  Finder(const ReferenceRows& rows, const ReferenceMeans& reference,
         std::span<const std::uint32_t> steps)
      : rows_(rows),
        reference_(reference),
        planes_(steps.size()),
        merged_(rows.tree.size()),
        place_(rows.tree.size()) {
    for (const std::uint32_t step : steps) steps_.emplace_back(step);
  }

  /// merges: of level `level` - 1, which join nodes of `level`.
  void find(std::span<const Merge> merges, int level, ReferenceCoefficients& found) {
    list_nodes(merges, level);
    const ReferenceTerms terms = find_reference_terms(reference_.moved, codes_, level);
    const std::int32_t* means = reference_.means[static_cast<std::size_t>(level)].data();
    values_.resize(nodes_.size() * planes_);
    there_.assign(nodes_.size(), 0);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      there_[n] = !terms.of(n).empty();
      if (there_[n])
        node_value(terms.of(n), means, roots_of(small_roots(), weights_[n]).root_q19, planes_,
                   &values_[n * planes_]);
    }
    for (std::size_t i = merges.size(); i-- > 0;) {  // children before parents
      const Merge& m = merges[i];
      const std::uint32_t left = place_[m.left], right = place_[m.right];
      there_[left] &= there_[right];
      if (!there_[left]) continue;
      std::int32_t* difference = &values_[right * planes_];
      forward_rows(m, &values_[left * planes_], difference, planes_);
      std::uint8_t* to = found.row(m.right);
      for (std::size_t j = 0; j < planes_; ++j) to[j] = quarters(difference[j], steps_[j]);
    }
  }

 private:
  /// Nodes of a level that are merged: others have no coefficient there.
  void list_nodes(std::span<const Merge> merges, int level) {
    nodes_.clear();
    codes_.clear();
    weights_.clear();
    for (const Merge& m : merges) merged_[m.left] = merged_[m.right] = 1;
    const int bits = reference_.moved.bits, lowest = 3 * (bits - level);
    const auto size = static_cast<std::uint32_t>(rows_.tree.size());
    for (std::uint32_t row = 0, end = 0; row < size; row = end) {
      end = row + 1;
      while (end < size && rows_.tree.split[end] < lowest) ++end;
      if (!merged_[row]) continue;
      merged_[row] = 0;
      place_[row] = static_cast<std::uint32_t>(nodes_.size());
      nodes_.push_back(row);
      codes_.push_back(rows_.codes[rows_.first[row]] >> lowest);
      weights_.push_back(rows_.first[end] - rows_.first[row]);
    }
  }

  const ReferenceRows& rows_;
  const ReferenceMeans& reference_;
  std::size_t planes_;
  std::vector<QuantiserStep> steps_;    // [planes]
  std::vector<std::uint8_t> merged_;    // [rows] 0 between calls
  std::vector<std::uint32_t> place_;    // [rows] of those in nodes_
  std::vector<std::uint32_t> nodes_;    // rows, ascending
  std::vector<std::uint64_t> codes_;    // of nodes_
  std::vector<std::uint32_t> weights_;  // of nodes_
  std::vector<std::uint8_t> there_;     // of nodes_: has the reference all of it?
  std::vector<std::int32_t> values_;    // of nodes_ [..][planes]
};

}  // namespace

ReferenceCoefficients find_reference_coefficients(const ReferenceRows& rows,
                                                  const ReferenceMeans& reference,
                                                  std::span<const std::uint32_t> steps) {
  ReferenceCoefficients found(rows.tree.size(), steps.size());
  Finder finder(rows, reference, steps);
  const std::span<const Merge> merges = rows.tree.merges;
  const int bits = reference.moved.bits;
  for (std::size_t begin = 0, end = 0; begin < merges.size(); begin = end) {
    const auto level_of = [&](std::size_t i) {
      return bits - rows.tree.split[merges[i].right] / 3;
    };
    const int level = level_of(begin);
    while (end < merges.size() && level_of(end) == level) ++end;
    finder.find(merges.subspan(begin, end - begin), level, found);
  }
  return found;
}

}  // namespace slf
