// SPDX-License-Identifier: Apache-2.0
#include "geometry/reference_cells.h"

#include <algorithm>
#include <bit>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::uint64_t kBrickFactor = 0x9E3779B97F4A7C15u;
constexpr std::int32_t kMostBrick = (1 << 21) - 1;

constexpr ReferenceBrick kEmpty{};

}  // namespace

ReferenceLevel::ReferenceLevel(std::span<const std::uint64_t> codes) {
  std::size_t bricks = 0;
  for (std::size_t i = 0; i < codes.size(); ++i)
    bricks += i == 0 || codes[i] >> 6 != codes[i - 1] >> 6;
  const int bits = std::max(static_cast<int>(std::bit_width(2 * bricks)), 1);
  table_.resize(std::size_t{1} << bits);
  shift_ = 64 - bits;
  ReferenceBrick* current = nullptr;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::uint64_t key = (codes[i] >> 6) + 1;
    if (current == nullptr || current->key != key) {
      std::size_t slot = key * kBrickFactor >> shift_;
      while (table_[slot].key != 0) slot = (slot + 1) & (table_.size() - 1);
      current = &table_[slot];
      current->key = key;
      current->first = static_cast<std::uint32_t>(i);
    }
    current->morton |= std::uint64_t{1} << (codes[i] & 63);
    const Voxel cell = from_morton(codes[i] & 63);
    current->cells |= bit_at(cell[0], cell[1], cell[2]);
  }
}

const ReferenceBrick& ReferenceLevel::brick(const Voxel& at) const {
  const auto [x, y, z] = at;
  if ((x | y | z) < 0 || x > kMostBrick || y > kMostBrick || z > kMostBrick) return kEmpty;
  const std::uint64_t key = morton(at) + 1;
  for (std::size_t slot = key * kBrickFactor >> shift_;; slot = (slot + 1) & (table_.size() - 1)) {
    if (table_[slot].key == key) return table_[slot];
    if (table_[slot].key == 0) return kEmpty;
  }
}

ReferenceCells::ReferenceCells(std::span<const std::uint64_t> codes, int bits) {
  codes_.resize(static_cast<std::size_t>(bits) + 1);
  codes_.back().assign(codes.begin(), codes.end());
  for (std::size_t l = codes_.size() - 1; l-- > 0;)
    for (const std::uint64_t code : codes_[l + 1])
      if (codes_[l].empty() || codes_[l].back() != code >> 3) codes_[l].push_back(code >> 3);
  for (const auto& level : codes_) levels_.emplace_back(level);
}

std::uint64_t ReferenceCells::bytes() const {
  std::uint64_t sum = 0;
  for (const auto& codes : codes_) sum += codes.capacity() * sizeof(std::uint64_t);
  for (const ReferenceLevel& level : levels_) sum += level.bytes();
  return sum;
}

}  // namespace slf
