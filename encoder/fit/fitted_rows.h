// SPDX-License-Identifier: Apache-2.0
// Coefficients of points in pieces, which can be given up one after the other.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace slf {

/// [P][row] floats. Rows may be written in parallel.
class FittedRows {
 public:
  /// All points in one piece.
  FittedRows(std::size_t points, std::size_t row) : FittedRows(points, row, points) {}

  /// @param of_piece  points, > 0
  FittedRows(std::size_t points, std::size_t row, std::size_t of_piece)
      : row_(row), of_piece_(std::max<std::size_t>(of_piece, 1)) {
    for (std::size_t first = 0; first < points; first += of_piece_)
      pieces_.emplace_back(std::min(of_piece_, points - first) * row, 0.0f);
  }

  std::size_t row() const { return row_; }
  float* of(std::size_t point) {
    return pieces_[point / of_piece_].data() + point % of_piece_ * row_;
  }

  /// [pieces] of consecutive points; whoever has read one may release it.
  std::vector<std::vector<float>>& pieces() { return pieces_; }

  /// Those of one piece.
  std::vector<float> take() && {
    return pieces_.empty() ? std::vector<float>{} : std::move(pieces_.front());
  }

 private:
  std::size_t row_, of_piece_;
  std::vector<std::vector<float>> pieces_;
};

}  // namespace slf
