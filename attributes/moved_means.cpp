// SPDX-License-Identifier: Apache-2.0
#include "attributes/moved_means.h"

#include <vector>

namespace slf {
namespace {

/// Nodes of a level: their codes, points in each, and sums of what these have.
struct NodeSums {
  std::vector<std::uint64_t> codes;
  std::vector<std::int64_t> points;
  std::vector<std::int64_t> sums;  // [nodes][planes], below 2^39
};

/// Nodes with the same code become one. shift: of the codes before
void join_equal(int shift, std::size_t planes, NodeSums& nodes) {
  std::size_t kept = 0;
  for (std::size_t n = 0; n < nodes.codes.size(); ++n) {
    const std::uint64_t code = nodes.codes[n] >> shift;
    const std::int64_t* from = &nodes.sums[n * planes];
    if (n > 0 && nodes.codes[kept - 1] == code) {
      nodes.points[kept - 1] += nodes.points[n];
      std::int64_t* to = &nodes.sums[(kept - 1) * planes];
      for (std::size_t j = 0; j < planes; ++j) to[j] += from[j];
      continue;
    }
    nodes.codes[kept] = code;
    nodes.points[kept] = nodes.points[n];
    std::int64_t* to = &nodes.sums[kept * planes];
    for (std::size_t j = 0; j < planes; ++j) to[j] = from[j];
    ++kept;
  }
  nodes.codes.resize(kept);
  nodes.points.resize(kept);
  nodes.sums.resize(kept * planes);
}

/// To nearest, halves upwards.
std::vector<std::int32_t> means_of(const NodeSums& nodes, std::size_t planes) {
  std::vector<std::int32_t> means(nodes.sums.size());
  for (std::size_t n = 0; n < nodes.codes.size(); ++n) {
    const std::int64_t twice = 2 * nodes.points[n];
    for (std::size_t j = 0; j < planes; ++j) {
      const std::int64_t sum = 2 * nodes.sums[n * planes + j] + nodes.points[n];
      const std::int64_t rest = sum % twice;
      means[n * planes + j] = static_cast<std::int32_t>(sum / twice - (rest < 0 ? 1 : 0));
    }
  }
  return means;
}

}  // namespace

LevelMeans moved_means(const MovedPoints& moved, std::span<const std::int32_t> values,
                       std::size_t planes, int bits) {
  NodeSums nodes;
  nodes.codes = moved.codes;
  nodes.points.assign(moved.codes.size(), 1);
  nodes.sums.reserve(moved.codes.size() * planes);
  for (const std::uint32_t p : moved.from)
    for (std::size_t j = 0; j < planes; ++j) nodes.sums.push_back(values[p * planes + j]);
  LevelMeans means(static_cast<std::size_t>(bits) + 1);
  for (int level = bits; level >= 0; --level) {
    join_equal(level == bits ? 0 : 3, planes, nodes);
    means[static_cast<std::size_t>(level)] = means_of(nodes, planes);
  }
  return means;
}

}  // namespace slf
