// SPDX-License-Identifier: Apache-2.0
// The vectors of a group that are not zero, for the contexts of those coded after them. Spec 8.7.2.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "base/huge_pages.h"

namespace slf {

/// By place in the coding order; place 0 stands for a vector of zeros.
class KeptVectors {
 public:
  static constexpr std::int32_t kLargest = 4095;  ///< magnitudes are kept up to this
  static constexpr std::size_t kBlock = 8;        ///< values that may be read together

  static constexpr std::size_t whole_blocks(std::size_t width) {
    return (width + kBlock - 1) / kBlock * kBlock;
  }

  /// width: planes of the group
  KeptVectors(std::size_t width, std::size_t num_points)
      : width_(width),
        sum_(num_points),
        vector_of_(num_points),
        runs_(num_points),
        vectors_(width + kBlock) {}

  /// [width] values within +-kLargest, and others to the end of the last block.
  const std::int16_t* vector(std::uint32_t place) const {
    return &vectors_[vector_of_[place] * width_];
  }
  std::uint32_t sum(std::uint32_t place) const { return sum_[place]; }    ///< of magnitudes
  std::uint32_t runs(std::uint32_t place) const { return runs_[place]; }  ///< up to the last value

  /// One more vector, of zeros: where it begins. There is room for all, on pages that are not there
  /// until they are used: vectors never move.
  std::int16_t* add() {
    const std::size_t begin = vectors_.size() - kBlock;
    if (begin == width_) reserve_large(vectors_, (sum_.size() + 1) * width_ + kBlock);
    vectors_.resize(begin + width_ + kBlock);
    return &vectors_[begin];
  }

  /// The vector that was added last is that of a place. sum: capped at 65535; runs: at 255
  void keep(std::size_t place, std::uint32_t sum, std::size_t runs) {
    vector_of_[place] = static_cast<std::uint32_t>((vectors_.size() - kBlock) / width_ - 1);
    sum_[place] = static_cast<std::uint16_t>(std::min(sum, 65535u));
    runs_[place] = static_cast<std::uint8_t>(std::min<std::size_t>(runs, 255));
  }

  /// Keeps for place `here` what `base` keeps for its place `there`. Spec 8.7.2, cell rows.
  void adopt(const KeptVectors& base, std::uint32_t there, std::uint32_t here) {
    if (base.vector_of_[there] == 0) return;
    const std::int16_t* vector = base.vector(there);
    std::copy(vector, vector + width_, add());
    keep(here, base.sum_[there], base.runs_[there]);
  }

 private:
  std::size_t width_;
  std::vector<std::uint16_t> sum_;        // [P] 65535 for more
  std::vector<std::uint32_t> vector_of_;  // [P] which of vectors_, 0: all zero
  std::vector<std::uint8_t> runs_;        // [P] of functions, at most 255
  std::vector<std::int16_t> vectors_;     // [..][width], and a block; the first is zero
};

}  // namespace slf
