// SPDX-License-Identifier: Apache-2.0
// How many points the cells of a base have, to a power of two. Written once for decoder and
// encoder. Spec 8.4.5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "base/multiversion.h"
#include "entropy/context_shape.h"
#include "entropy/mixed_bit.h"
#include "geometry/octree_levels.h"

namespace slf {

inline constexpr std::uint32_t kMostWeightClass = 22;                     ///< of 2^22 points
inline constexpr std::uint64_t kMostBaseWeight = std::uint64_t{1} << 24;  ///< of all cells together

/// The class of a cell of so many points, at least one: their logarithm to the nearest integer.
std::uint8_t weight_class(std::uint64_t points);

/// [cells + 1] what the cells before each weigh together, which is at most 2^24 in the end.
std::vector<std::uint32_t> weights_before(std::span<const std::uint8_t> classes);

/// Codes the classes of a level's cells one by one, in their order.
class WeightClassModel {
 public:
  /// cells: with neighbours; kept by reference.
  explicit WeightClassModel(const OctreeLevel& cells);

  /// Codes the class of the next cell. The encoder passes it, the decoder 0; both get it back: 0 ..
  /// kMostWeightClass.
  template <class Coder>
  SLF_OWN_CALL std::uint8_t code(Coder& coder, std::uint8_t value) {
    const auto selected = more_.select(next_contexts());
    std::uint8_t k = 0;
    while (k < kMostWeightClass && more_.code(coder, selected, k, k, value > k)) ++k;
    classes_.push_back(k);
    return k;
  }

  /// Classes of the cells so far.
  const std::vector<std::uint8_t>& classes() const { return classes_; }

 private:
  /// The last: the class so far.
  using Beside = ContextShape<4 * (3 * kMostWeightClass + 1), kMostWeightClass>;
  using Faces = ContextShape<1u << 6, kMostWeightClass>;
  using Family = ContextShape<1u << 8, kMostWeightClass>;

  /// Contexts of the decision whether the next cell's class is more than 0; those of more than k
  /// are k behind.
  std::array<std::uint32_t, 3> next_contexts();

  const OctreeLevel* cells_;
  std::vector<std::uint8_t> classes_;
  std::size_t family_end_ = 0;  // first cell that has another parent than the latest
  std::uint32_t family_ = 0;    // occupancy of that parent
  MixedBit<kMostWeightClass, Beside, Faces, Family> more_;
};

}  // namespace slf
