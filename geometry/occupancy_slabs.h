// SPDX-License-Identifier: Apache-2.0
// What the nodes of a level in one slab have in common. Spec 8.4.8.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "entropy/context_bit.h"
#include "geometry/morton.h"

namespace slf {

/// A slab is all that has one coordinate along an axis. Vertices of a mesh that was cut out of a
/// volume lie on few of the slabs of a finer grid.
class OccupancySlabs {
 public:
  /// cells: of the level, all coded; leaves the contexts new.
  void finish_level(std::span<const std::uint64_t> cells, int level);

  /// What a slab of the node says of a place of its only child (8.4.6).
  struct Place {
    std::size_t axis;     ///< that the place decides; 3: none
    ContextBit* context;  ///< null: none
    std::int16_t input;   ///< logistic; 0: nothing
    std::size_t sixteenth() const {
      return static_cast<std::size_t>(std::clamp((input + 2048) >> 8, 0, 15));
    }
    void update(unsigned bit) const {
      if (context != nullptr) context->update(bit);
    }
  };
  Place place(unsigned place, const Voxel& node) {
    if (place == 0) return {3, nullptr, 0};
    const std::size_t axis = 3 - static_cast<std::size_t>(std::bit_width(place));
    ContextBit& context = only_[axis][slot(node[axis])];
    return {axis, &context, context.logistic()};
  }

  /// What the three slabs of each child of a node say: a byte for each, 2 bits an axis, x the
  /// lowest.
  std::uint64_t children(const Voxel& node) const {
    // Children in the lower half along x, y, z, as bytes; those in the upper half are as far on as
    // a child is.
    constexpr std::array<std::uint64_t, 3> kLower = {0x0001000100010001u, 0x0000010100000101u,
                                                     0x0000000001010101u};
    std::uint64_t classes = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::uint64_t lower = class_of(halves_[axis][slot(2 * node[axis])]),
                          upper = class_of(halves_[axis][slot(2 * node[axis] + 1)]);
      classes |= (lower | upper << (8u << axis)) * kLower[axis] << (2 * axis);
    }
    return classes;
  }
  /// Learns which halves of the node have a child.
  void store(const Voxel& node, unsigned occupancy) {
    constexpr std::array<unsigned, 3> kLower = {0x55, 0x33, 0x0F};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      halves_[axis][slot(2 * node[axis])].update((occupancy & kLower[axis]) != 0);
      halves_[axis][slot(2 * node[axis] + 1)].update((occupancy & ~kLower[axis]) != 0);
    }
  }

 private:
  static constexpr std::size_t kSlots = 4096;

  static unsigned class_of(ContextBit half) {
    return static_cast<unsigned>(std::clamp((half.logistic() + 1024) >> 9, 0, 3));
  }
  static std::size_t slot(std::int32_t at) { return static_cast<std::size_t>(at) % kSlots; }

  using Contexts = std::vector<ContextBit>;
  std::array<Contexts, 3> only_{Contexts(kSlots), Contexts(kSlots), Contexts(kSlots)};
  std::array<Contexts, 3> halves_ = only_;  // by the coordinate of a child: does a node have one?
};

}  // namespace slf
