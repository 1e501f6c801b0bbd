// SPDX-License-Identifier: Apache-2.0
// The rows around a row whose vectors tell what its own may be. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "attributes/coefficient_neighbours.h"
#include "attributes/kept_vectors.h"
#include "attributes/vector_states.h"
#include "base/prefetch.h"
#include "entropy/log_class.h"

namespace slf {

/// The rows around one, by place, 0 where there is none, and what their magnitudes say of its
/// own.
struct Around {
  static constexpr std::size_t kParents = 3;  ///< parent, its parent, and that one's
  static constexpr std::size_t kRows = 7;     ///< and the faces towards lower x, y, z; the previous
  static constexpr std::uint32_t kTopSplit = VectorStates::kTopSplit;

  std::array<std::uint32_t, kRows> row{};
  std::array<std::uint32_t, kRows> weight{};  // 8 fractional bits; 0 also for a zero vector
  bool any_beside = false;
  std::uint32_t same_axis = 0;      // nearest of the parents whose split is along the same axis
  std::uint32_t split = kTopSplit;  // at most
  std::uint32_t axis = 2;           // 0 .. 2, of the split
  std::uint32_t scale_class = 0;
};

using NeighbourRows = std::vector<CoefficientNeighbours::Row>;

/// A difference between means is as likely large here as there; coefficients are differences
/// times scale.
inline void set_weights(const NeighbourRows& rows, const KeptVectors& kept, std::uint32_t scale,
                        Around& around) {
  constexpr std::array<std::uint32_t, Around::kRows> kShares = {2, 2, 1, 3, 3, 3, 1};
  constexpr std::uint32_t kParentShares = 5;
  constexpr std::uint32_t kMostWeight = 32767;  // times 7 * kLargest stays below 2^31
  std::uint32_t shares_beside = 0;
  for (std::size_t k = Around::kParents; k < Around::kRows; ++k)
    if (around.row[k] != 0) shares_beside += kShares[k];
  around.any_beside = shares_beside > 0;
  for (std::size_t k = 0; k < Around::kRows; ++k) {
    if (kept.sum(around.row[k]) == 0) continue;  // the sum of place 0 stays 0
    prefetch(kept.vector(around.row[k]));
    const std::uint32_t shares = k < Around::kParents ? kParentShares : shares_beside;
    around.weight[k] =
        std::min(kShares[k] * scale * 256 / (rows[around.row[k]].scale * shares), kMostWeight);
  }
}

/// The neighbours of place i in the coding order.
inline Around around_of(const NeighbourRows& rows, const KeptVectors& kept, std::size_t i) {
  const CoefficientNeighbours::Row& row = rows[i];
  Around around;
  around.scale_class = log_class(row.scale >> 5, 23);
  if (i == 0) return around;
  around.split = std::min<std::uint32_t>(row.split, Around::kTopSplit);
  around.axis = row.split % 3u;
  std::uint32_t up = row.parent;
  for (std::size_t k = 0; k < Around::kParents; ++k) {
    around.row[k] = up;
    if (up != 0 && around.same_axis == 0 && rows[up].split % 3u == around.axis)
      around.same_axis = up;
    up = rows[up].parent;
  }
  for (std::size_t axis = 0; axis < 3; ++axis)
    around.row[Around::kParents + axis] = row.faces[axis];
  if (rows[i - 1].split == row.split)
    around.row[Around::kRows - 1] = static_cast<std::uint32_t>(i - 1);
  set_weights(rows, kept, row.scale, around);
  return around;
}

}  // namespace slf
