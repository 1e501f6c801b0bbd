// A linear transform across the planes of a row: few coded components give many functions.
// Spec 8.7.5.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/raht_tree.h"
#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"
#include "slf/error.h"

namespace slf {

/// The components stand in the planes of the first `rank` functions. With lanes = 3 the three
/// channels are transformed alike, each by itself; with lanes = 1 (joint) all planes together.
struct PlaneTransform {
  static constexpr int kFractionBits = 14;
  static constexpr std::uint32_t kMaxEntries = 1u << 20;
  static constexpr std::int32_t kEntryLimit = 1 << 20;  ///< |entry| <= this: 64
  static constexpr int kColourBits = 9;
  static constexpr std::array<std::array<std::int32_t, 3>, 3> kNoColour{
      {{1 << kColourBits, 0, 0}, {0, 1 << kColourBits, 0}, {0, 0, 1 << kColourBits}}};

  std::size_t first_group = 0, num_groups = 1;
  std::vector<std::uint16_t> functions;  ///< of its groups, by group, ascending within one
  std::size_t rank = 0;                  ///< functions whose planes hold components, >= 1
  std::size_t lanes = 3;                 ///< 3, or 1
  /// With 3 lanes: from coded channels (columns) to channels, 9 fractional bits, |entry| <= 512.
  std::array<std::array<std::int32_t, 3>, 3> colour = kNoColour;
  std::vector<std::int32_t> matrix;  ///< [columns][rows], 14 fractional bits

  std::size_t rows() const { return functions.size() * 3 / lanes; }
  std::size_t columns() const { return rank * 3 / lanes; }
  /// Offset in a row of lane 0 of element i: of the values, or of the components.
  std::size_t plane(std::size_t i) const {
    return lanes == 3 ? std::size_t{3} * functions[i] : std::size_t{3} * functions[i / 3] + i % 3;
  }
};

/// What expand_row works on; only its memory is kept from row to row.
struct ExpansionScratch {
  std::vector<std::uint32_t> columns;
  std::vector<std::int64_t> sums;
};

/// Replaces the quantised components of a row by the values of the functions; the planes of the
/// transform that hold no component are zero on entry.
/// @param steps  [planes]
/// Returns false where a value reaches 2^27; its lane counts as 0.
bool expand_row(const PlaneTransform& transform, std::span<const std::uint32_t> steps,
                std::int32_t* row, ExpansionScratch& scratch);

/// The same for all rows of values, [P][planes].
/// @param nonzero  [P] 0: the row is zero; empty: any may be other
/// @errors kOutOfRange: a value of 2^27 or more.
Result<Done> expand_components(const PlaneTransform& transform,
                               std::span<const std::uint32_t> steps, std::span<std::int32_t> values,
                               int threads, std::span<const std::uint8_t> nonzero = {});

/// Codes the matrix, column by column, entries in 2^-precision[column]. Written once for decoder
/// and encoder. Spec 7.11. Returns false where the decoder met a value no encoder writes.
/// @param precision  [columns] 0 .. 14: fractional bits; the decoder does not read it
template <class Coder>
bool code_matrix(Coder& coder, PlaneTransform& t, std::span<const std::uint8_t> precision) {
  constexpr std::uint32_t kLimit = 255;
  constexpr std::size_t kClasses = 16;
  std::vector<AdaptiveBit> nonzero(kClasses);
  std::vector<MagnitudeContexts> magnitude(kClasses);
  const std::size_t rows = t.rows();
  const auto root = static_cast<std::uint32_t>(isqrt(rows));
  t.matrix.resize(rows * t.columns());
  for (std::size_t c = 0; c < t.columns(); ++c) {
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
