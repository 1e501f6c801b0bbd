// SPDX-License-Identifier: Apache-2.0
// The values of the frame that a frame is predicted from, at every level. Spec 8.12.4.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "geometry/reference_view.h"

namespace slf {

/// [levels + 1][nodes][planes] means of the nodes as a decoder that keeps so many levels gives
/// them, at most 2^17 in magnitude.
using LevelMeans = std::vector<std::vector<std::int32_t>>;

/// Nodes of the reference, one above the other at the place a node came from.
struct ReferenceTerm {
  std::uint32_t node;
  std::int32_t weight;  ///< of 4096; those of a node add up to it
};

/// Those of nodes of a level: linear between the centres of nodes that are there.
struct ReferenceTerms {
  std::vector<std::uint32_t> first;  ///< [nodes + 1]
  std::vector<ReferenceTerm> terms;

  std::span<const ReferenceTerm> of(std::size_t node) const {
    return std::span(terms).subspan(first[node], first[node + 1] - first[node]);
  }
};

/// @param codes  of nodes of the level, ascending. O(nodes)
ReferenceTerms find_reference_terms(const MovedReference& reference,
                                    std::span<const std::uint64_t> codes, int level);

/// Those of the nodes of a frame that have siblings, the only ones that anything is predicted of:
/// contexts (8.12.6) and prediction (8.7.6) ask for the same.
class LevelTerms {
 public:
  /// codes(): of all nodes of the level with siblings, ascending; asked for the first time alone
  template <class Codes>
  const ReferenceTerms& of(const MovedReference& reference, int level, const Codes& codes) {
    const auto l = static_cast<std::size_t>(level);
    if (found_.size() <= l) found_.resize(l + 1);
    if (found_[l].first.empty()) found_[l] = find_reference_terms(reference, codes(), level);
    return found_[l];
  }

 private:
  std::deque<ReferenceTerms> found_;  // by level; they stay where they are
};

struct ReferenceMeans {
  MovedReference moved;
  const LevelMeans& means;
  LevelTerms& terms;
};

}  // namespace slf
