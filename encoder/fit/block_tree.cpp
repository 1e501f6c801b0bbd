// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/block_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/morton.h"

namespace slf {

BlockTree::BlockTree(std::span<const Voxel> positions, int block_log2) : block_log2_(block_log2) {
  std::vector<std::uint64_t> codes;  // of the level at hand
  std::vector<std::size_t> first;
  const auto add = [&](std::uint64_t code, std::size_t from) {
    if (!codes.empty() && codes.back() == code) return;
    codes.push_back(code);
    first.push_back(from);
  };
  const auto finish = [&](std::size_t last) {
    first.push_back(last);
    codes_.push_back(std::exchange(codes, {}));
    first_.push_back(std::exchange(first, {}));
  };
  for (std::size_t p = 0; p < positions.size(); ++p)
    add(morton(positions[p]) >> (3 * block_log2), p);
  finish(positions.size());
  while (codes_.back().size() > 1) {  // up to the block that holds all
    for (std::size_t b = 0; b < codes_.back().size(); ++b) add(codes_.back()[b] >> 3, b);
    finish(codes_.back().size());
  }
}

BlockBlend BlockTree::above(std::size_t level, std::size_t b) const {
  return between(level + 1, from_morton(codes_[level][b]), 1);
}

/// @param place  a voxel, or a block, in a block of `level`; of this side in units of `place`
BlockBlend BlockTree::between(std::size_t level, const Voxel& place, int side_log2) const {
  Voxel low{};  // the block whose middle is the next towards 0
  std::array<float, 3> beyond{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    // Middles, doubled: those of place and block are between units.
    const std::int64_t side = std::int64_t{1} << side_log2;
    const std::int64_t at = 2 * std::int64_t{place[axis]} + 1 - side;
    low[axis] = static_cast<std::int32_t>(at >> (side_log2 + 1));
    beyond[axis] = static_cast<float>(at - 2 * side * low[axis]) / static_cast<float>(2 * side);
  }
  const std::vector<std::uint64_t>& codes = codes_[level];
  BlockBlend blend;
  float sum = 0;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    Voxel block = low;
    float weight = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const bool upper = (corner >> axis & 1) != 0;
      block[axis] += upper;
      weight *= upper ? beyond[axis] : 1 - beyond[axis];
    }
    if (weight == 0 || std::min({block[0], block[1], block[2]}) < 0) continue;
    const auto found = std::lower_bound(codes.begin(), codes.end(), morton(block));
    if (found == codes.end() || *found != morton(block)) continue;
    blend.block[blend.count] = static_cast<std::size_t>(found - codes.begin());
    blend.weight[blend.count++] = weight;
    sum += weight;  // 1 / 8 or more with the block that has the place
  }
  for (float& weight : blend.weight) weight /= sum;
  return blend;
}

}  // namespace slf
