// SPDX-License-Identifier: Apache-2.0
#include "attributes/reference_means.h"

#include "geometry/morton.h"

namespace slf {
namespace {

/// Up to eight nodes and their weights of 512.
struct NodesAround {
  std::array<std::uint32_t, 8> node{};
  std::array<std::int32_t, 8> weight{};
  std::size_t count = 0;
  std::int32_t sum = 0;
};

/// @param at_q3  place in eighths of a node from the centre of node 0 on
NodesAround nodes_around(const ReferenceLevel& level, const std::array<std::int32_t, 3>& at_q3) {
  NodesAround around;
  for (int corner = 0; corner < 8; ++corner) {
    std::int32_t weight = 1;
    Voxel cell{};
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t upper = corner >> i & 1, in = at_q3[i] & 7;
      cell[i] = (at_q3[i] >> 3) + upper;
      weight *= upper != 0 ? in : 8 - in;
    }
    if (weight == 0) continue;
    const std::uint32_t node = level.find(cell);
    if (node == ReferenceLevel::kNone) continue;
    around.node[around.count] = node;
    around.weight[around.count++] = weight;
    around.sum += weight;
  }
  return around;
}

}  // namespace

ReferenceTerms find_reference_terms(const MovedReference& reference,
                                    std::span<const std::uint64_t> codes, int level) {
  const ReferenceLevel& there = reference.cells.level(level);
  const int side_log2 = reference.bits - level + 4;  // of a node, in sixteenths of a voxel
  ReferenceTerms found;
  found.first.reserve(codes.size() + 1);
  found.first.push_back(0);
  for (const std::uint64_t code : codes) {
    const Voxel node = from_morton(code);
    const Displacement moved = reference.at(node, level);
    std::array<std::int32_t, 3> at_q3;
    for (std::size_t i = 0; i < 3; ++i)
      at_q3[i] = 8 * node[i] + ((moved[i] + (1 << (side_log2 - 4))) >> (side_log2 - 3));
    const NodesAround around = nodes_around(there, at_q3);
    std::int32_t left = 4096;
    for (std::size_t i = 0; i < around.count; ++i) {
      const std::int32_t weight =
          i + 1 < around.count ? 4096 * around.weight[i] / around.sum : left;
      found.terms.push_back({around.node[i], weight});
      left -= weight;
    }
    found.first.push_back(static_cast<std::uint32_t>(found.terms.size()));
  }
  return found;
}

}  // namespace slf
