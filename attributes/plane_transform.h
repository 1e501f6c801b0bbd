// SPDX-License-Identifier: Apache-2.0
// A linear transform across the planes of a point: few components give many functions. Spec 7.11,
// 8.7.5.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <span>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"
#include "geometry/isqrt.h"
#include "slf/plane_transform.h"

namespace slf {

/// Columns of a matrix, from `begin` to before `end`.
struct ColumnRange {
  std::size_t begin = 0, end = 0;
  bool empty() const { return begin == end; }
};

/// Codes columns of the matrix, one by one, entries in 2^-precision[column]. Written once for
/// decoder and encoder. Spec 7.11. Returns false where the decoder met a value no encoder writes.
/// @param precision  [columns] 0 .. 14: fractional bits; the decoder does not read it
template <class Coder>
bool code_columns(Coder& coder, PlaneTransform& t, ColumnRange columns,
                  std::span<const std::uint8_t> precision) {
  constexpr std::uint32_t kLimit = 255;
  constexpr std::size_t kClasses = 16;
  std::vector<AdaptiveBit> nonzero(kClasses);
  std::vector<MagnitudeContexts> magnitude(kClasses);
  const std::size_t rows = t.rows();
  const auto root = static_cast<std::uint32_t>(isqrt(rows));
  for (std::size_t c = columns.begin; c < columns.end; ++c) {
    const std::uint32_t bits = coder.raw(4, Coder::kDecodes ? 0 : precision[c]);
    if (bits > PlaneTransform::kFractionBits) return false;
    const auto shift = PlaneTransform::kFractionBits - static_cast<int>(bits);
    const auto most = static_cast<std::uint32_t>(PlaneTransform::kEntryLimit >> shift);
    // Sixteenths of the magnitude expected: of a column of length 1, then of the entries coded.
    std::uint32_t expected = (16u << bits) / root;
    for (std::size_t r = 0; r < rows; ++r) {
      std::int32_t& entry = t.matrix[c * rows + r];
      const auto given = static_cast<std::uint32_t>(Coder::kDecodes ? 0 : std::abs(entry) >> shift);
      const auto context = std::min<std::size_t>(std::bit_width(expected), kClasses - 1);
      std::uint32_t m = 0;
      bool negative = false;
      if (coder.bit(nonzero[context], kLimit, given != 0)) {
        m = code_magnitude(coder, magnitude[context], kLimit, given);
        if (m == 0 || m > most) return false;
        negative = coder.raw(1, entry < 0) != 0;
      }
      if (Coder::kDecodes) {
        const auto value = static_cast<std::int32_t>(m << shift);
        entry = negative ? -value : value;
      }
      expected = (3 * expected + 16 * m) / 4;
    }
  }
  return true;
}

}  // namespace slf
