// SPDX-License-Identifier: Apache-2.0
// The cells around the children of an octree node, as bits. Spec 8.4.1, 8.4.2.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/table.h"
#include "geometry/octree_levels.h"

namespace slf {

/// 4 x 4 x 4 cells of the child level around a node's own 2 x 2 x 2; bit x + 4 y + 16 z with
/// x, y, z = 0 .. 3. The 3 x 3 x 3 around a child use the same bits.
using Window = std::uint64_t;

constexpr Window bit_at(int x, int y, int z) { return Window{1} << (x + 4 * y + 16 * z); }

/// The cells of the window that lie in a direction's neighbour. [direction]
inline constexpr std::array<Window, 27> kWindowParts = [] {
  std::array<Window, 27> parts{};
  for (int z = 0; z < 4; ++z)
    for (int y = 0; y < 4; ++y)
      for (int x = 0; x < 4; ++x)
        parts[static_cast<std::size_t>(
            direction_index((x + 1) / 2 - 1, (y + 1) / 2 - 1, (z + 1) / 2 - 1))] |= bit_at(x, y, z);
  return parts;
}();

/// std::rotl, of which libc++ makes a function that asks for the sign first.
constexpr Window turned(Window cells, int shift) {
  return cells << (shift & 63) | cells >> (-shift & 63);
}

/// By how many bits the cells of a direction's neighbour are further on than the node's own.
inline constexpr std::array<int, 27> kWindowShift = [] {
  std::array<int, 27> shift{};
  for (int d = 0; d < 27; ++d)
    shift[static_cast<std::size_t>(d)] = 2 * (d % 3 - 1) + 8 * (d / 3 % 3 - 1) + 32 * (d / 9 - 1);
  return shift;
}();

constexpr Window own_cell(int child) {
  return bit_at(1 + (child & 1), 1 + (child >> 1 & 1), 1 + (child >> 2));
}

/// The node's own children as cells. [occupancy]
SLF_TABLE std::array<Window, 256> kOwnCells = [] {
  SLF_TABLE_BEGINS;
  std::array<Window, 256> cells{};
  for (std::size_t o = 0; o < 256; ++o)
    for (int c = 0; c < 8; ++c)
      if (o >> c & 1) cells[o] |= own_cell(c);
  return cells;
}();

/// The cells of the 3 x 3 x 3 around a child but itself.
inline constexpr Window kAllAround = [] {
  Window mask = 0;
  for (int z = 0; z < 3; ++z)
    for (int y = 0; y < 3; ++y)
      for (int x = 0; x < 3; ++x) mask |= bit_at(x, y, z);
  return mask & ~bit_at(1, 1, 1);
}();

/// The 26 cells around a child: known to be occupied, not known yet.
struct Surroundings {
  Window occupied, unknown;
};

/// occupied, unknown: the window of a node.
inline Surroundings surroundings(Window occupied, Window unknown, unsigned child) {
  const unsigned base = (child & 1) + 4 * (child >> 1 & 1) + 16 * (child >> 2);
  return {occupied >> base & kAllAround, unknown >> base & kAllAround};
}

/// By child and by which of the eight nodes around its outer corner are occupied, x + 2y + 4z
/// there: the seven that are not its own, over faces in x, y, z, over edges in xy, xz, yz, over the
/// corner.
SLF_TABLE std::array<std::array<std::uint8_t, 256>, 8> kCorner = [] {
  SLF_TABLE_BEGINS;
  constexpr std::array<unsigned, 7> kSteps = {1, 2, 4, 3, 5, 6, 7};
  std::array<std::array<std::uint8_t, 256>, 8> table{};
  for (unsigned child = 0; child < 8; ++child)
    for (unsigned block = 0; block < 256; ++block)
      for (unsigned i = 0; i < 7; ++i)
        table[child][block] = static_cast<std::uint8_t>(
            table[child][block] | (block >> (7 ^ child ^ kSteps[i]) & 1u) << i);
  return table;
}();

/// neighbours: bit d: the node's neighbour in direction d is occupied.
inline unsigned corner_of(std::uint32_t neighbours, unsigned child) {
  const std::uint32_t n = neighbours >> ((child & 1) + 3 * (child >> 1 & 1) + 9 * (child >> 2));
  return kCorner[child][(n & 3) | (n >> 1 & 12) | (n >> 5 & 48) | (n >> 6 & 192)];
}

}  // namespace slf
