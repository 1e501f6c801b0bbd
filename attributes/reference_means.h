// SPDX-License-Identifier: Apache-2.0
// The values of the frame that a frame is predicted from, at every level. Spec 8.12.4.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "geometry/reference_view.h"

namespace slf {

/// [levels + 1][nodes][planes] means of the nodes as a decoder that keeps so many levels gives
/// them, at most 2^17 in magnitude.
using LevelMeans = std::vector<std::vector<std::int32_t>>;

struct ReferenceMeans {
  MovedReference moved;
  const LevelMeans& means;
};

/// Nodes of the reference, one above the other at the place a node came from.
struct ReferenceTerm {
  std::uint32_t node;
  std::int32_t weight;  ///< of 4096; those of a node add up to it
};

/// Those of the nodes of a level: linear between the centres of nodes that are there.
struct ReferenceTerms {
  std::vector<std::uint32_t> first;  ///< [nodes + 1]
  std::vector<ReferenceTerm> terms;

  std::span<const ReferenceTerm> of(std::size_t node) const {
    return std::span(terms).subspan(first[node], first[node + 1] - first[node]);
  }
};

/// @param codes  of nodes of the level. O(nodes)
ReferenceTerms find_reference_terms(const MovedReference& reference,
                                    std::span<const std::uint64_t> codes, int level);

}  // namespace slf
