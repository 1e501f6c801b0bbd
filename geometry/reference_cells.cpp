// SPDX-License-Identifier: Apache-2.0
#include "geometry/reference_cells.h"

#include <bit>

#include "geometry/morton.h"

namespace slf {
namespace {

constexpr std::uint64_t kBrickFactor = 0x9E3779B97F4A7C15u;
constexpr std::int32_t kMostCell = (1 << 21) - 1;

/// Cells 0 .. 3 along an axis, of two bricks that follow one another there, from `offset` on.
/// stride: bits from a cell to the next along the axis; kept: [offset] cells of the first brick
Window shifted(Window low, Window high, int offset, int stride, const std::array<Window, 4>& kept) {
  if (offset == 0) return low;
  const Window from_low = kept[static_cast<std::size_t>(offset)];
  return (low >> (offset * stride) & from_low) | (high << ((4 - offset) * stride) & ~from_low);
}

/// [axis][offset] cells at 0 .. 3 - offset along the axis.
constexpr auto kKept = [] {
  std::array<std::array<Window, 4>, 3> table{};
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x)
        for (int offset = 0; offset < 4; ++offset) {
          const auto o = static_cast<std::size_t>(offset);
          if (x < 4 - offset) table[0][o] |= bit_at(x, y, z);
          if (y < 4 - offset) table[1][o] |= bit_at(x, y, z);
          if (z < 4 - offset) table[2][o] |= bit_at(x, y, z);
        }
  return table;
}();

}  // namespace

ReferenceLevel::ReferenceLevel(std::span<const std::uint64_t> codes) {
  std::size_t bricks = 0;
  for (std::size_t i = 0; i < codes.size(); ++i)
    bricks += i == 0 || codes[i] >> 6 != codes[i - 1] >> 6;
  const int bits = static_cast<int>(std::bit_width(2 * bricks));
  table_.resize(std::size_t{1} << bits);
  shift_ = 64 - bits;
  Brick* current = nullptr;
  for (std::size_t i = 0; i < codes.size(); ++i) {
    const std::uint64_t key = (codes[i] >> 6) + 1;
    if (current == nullptr || current->key != key) {
      std::size_t slot = bits == 0 ? 0 : key * kBrickFactor >> shift_;
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

const ReferenceLevel::Brick* ReferenceLevel::brick(std::int32_t x, std::int32_t y,
                                                   std::int32_t z) const {
  if ((x | y | z) < 0 || x > kMostCell || y > kMostCell || z > kMostCell) return nullptr;
  const std::uint64_t key = morton({x, y, z}) + 1;
  for (std::size_t slot = key * kBrickFactor >> shift_;; slot = (slot + 1) & (table_.size() - 1)) {
    if (table_[slot].key == key) return &table_[slot];
    if (table_[slot].key == 0) return nullptr;
  }
}

Window ReferenceLevel::window(const Voxel& first) const {
  const std::array<std::int32_t, 3> offset = {first[0] & 3, first[1] & 3, first[2] & 3};
  const auto cells = [&](int dx, int dy, int dz) {
    if ((dx && offset[0] == 0) || (dy && offset[1] == 0) || (dz && offset[2] == 0))
      return Window{0};
    const Brick* b = brick((first[0] >> 2) + dx, (first[1] >> 2) + dy, (first[2] >> 2) + dz);
    return b != nullptr ? b->cells : Window{0};
  };
  std::array<Window, 2> along_z{};
  for (int dz = 0; dz < 2; ++dz) {
    std::array<Window, 2> along_y{};
    for (int dy = 0; dy < 2; ++dy)
      along_y[static_cast<std::size_t>(dy)] =
          shifted(cells(0, dy, dz), cells(1, dy, dz), offset[0], 1, kKept[0]);
    along_z[static_cast<std::size_t>(dz)] = shifted(along_y[0], along_y[1], offset[1], 4, kKept[1]);
  }
  return shifted(along_z[0], along_z[1], offset[2], 16, kKept[2]);
}

std::uint32_t ReferenceLevel::find(const Voxel& cell) const {
  const Brick* b = brick(cell[0] >> 2, cell[1] >> 2, cell[2] >> 2);
  if (b == nullptr) return kNone;
  const auto bit = static_cast<int>(morton({cell[0] & 3, cell[1] & 3, cell[2] & 3}));
  if ((b->morton >> bit & 1) == 0) return kNone;
  return b->first +
         static_cast<std::uint32_t>(std::popcount(b->morton & ((std::uint64_t{1} << bit) - 1)));
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
