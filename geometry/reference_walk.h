// SPDX-License-Identifier: Apache-2.0
// Cells of a level of the reference, asked for one after the other: the bricks of those before stay
// at hand. What is asked in Morton order, moved by a motion that changes slowly, finds nearly all
// of them there. Spec 8.12.2.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

#include "base/multiversion.h"
#include "geometry/reference_cells.h"

namespace slf {

class ReferenceWalk {
 public:
  ReferenceWalk() = default;
  explicit ReferenceWalk(const ReferenceLevel& level) { start_level(level); }

  /// level: kept by pointer
  void start_level(const ReferenceLevel& level) {
    level_ = &level;
    recent_.fill({});
  }

  /// at: in bricks; it may lie outside of the grid, where no cell is
  const ReferenceBrick& brick(const Voxel& at) {
    Recent& recent =
        recent_[static_cast<std::size_t>((at[0] & 3) | (at[1] & 3) << 2 | (at[2] & 3) << 4)];
    if (recent.brick == nullptr ||
        ((recent.at[0] ^ at[0]) | (recent.at[1] ^ at[1]) | (recent.at[2] ^ at[2])) != 0)
      recent = {&level_->brick(at), at};
    return *recent.brick;
  }

  /// The 4 x 4 x 4 cells from `first` on, which may lie outside of the grid.
  Window window(const Voxel& first) {
    const std::array<std::int32_t, 3> offset = {first[0] & 3, first[1] & 3, first[2] & 3};
    const auto cells = [&](int dx, int dy, int dz) {
      if ((dx && offset[0] == 0) || (dy && offset[1] == 0) || (dz && offset[2] == 0))
        return Window{0};
      return brick({(first[0] >> 2) + dx, (first[1] >> 2) + dy, (first[2] >> 2) + dz}).cells;
    };
    std::array<Window, 2> along_z{};
    for (int dz = 0; dz < 2; ++dz) {
      std::array<Window, 2> along_y{};
      for (int dy = 0; dy < 2; ++dy)
        along_y[static_cast<std::size_t>(dy)] =
            shifted(cells(0, dy, dz), cells(1, dy, dz), offset[0], 1, kKept[0]);
      along_z[static_cast<std::size_t>(dz)] =
          shifted(along_y[0], along_y[1], offset[1], 4, kKept[1]);
    }
    return shifted(along_z[0], along_z[1], offset[2], 16, kKept[2]);
  }

  /// Place of a cell among the codes of the level; ReferenceLevel::kNone where it is empty.
  std::uint32_t find(const Voxel& cell) {
    const ReferenceBrick& there = brick({cell[0] >> 2, cell[1] >> 2, cell[2] >> 2});
    const unsigned bit = bit_of(cell);
    return (there.morton >> bit & 1) == 0 ? ReferenceLevel::kNone : place_in(there, bit);
  }

  /// Bit of a cell in ReferenceBrick::morton, by its lowest two bits.
  static unsigned bit_of(const Voxel& cell) {
    constexpr std::array<std::uint8_t, 4> kSpread = {0, 1, 8, 9};
    return static_cast<unsigned>(kSpread[static_cast<std::size_t>(cell[0] & 3)] |
                                 kSpread[static_cast<std::size_t>(cell[1] & 3)] << 1 |
                                 kSpread[static_cast<std::size_t>(cell[2] & 3)] << 2);
  }
  /// Place of the cell with that bit among the codes of the level, if it is there.
  static std::uint32_t place_in(const ReferenceBrick& brick, unsigned bit) {
    const std::uint64_t before = brick.morton & ((std::uint64_t{1} << bit) - 1);
    return brick.first + static_cast<std::uint32_t>(std::popcount(before));
  }

 private:
  struct Recent {
    const ReferenceBrick* brick = nullptr;
    Voxel at{};
  };

  /// [axis][offset] cells at 0 .. 3 - offset along the axis.
  static constexpr auto kKept = [] {
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

  /// Cells 0 .. 3 along an axis, of two bricks that follow one another there, from `offset` on.
  /// stride: bits from a cell to the next along the axis; kept: [offset] cells of the first brick
  static Window shifted(Window low, Window high, int offset, int stride,
                        const std::array<Window, 4>& kept) {
    if (offset == 0) return low;
    const Window from_low = kept[static_cast<std::size_t>(offset)];
    return (low >> (offset * stride) & from_low) | (high << ((4 - offset) * stride) & ~from_low);
  }

  const ReferenceLevel* level_ = nullptr;
  std::array<Recent, 64> recent_{};  // by the lowest two bits of a brick's place
};

}  // namespace slf
