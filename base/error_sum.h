// SPDX-License-Identifier: Apache-2.0
// Squared errors of 8-bit colours, and the PSNRs of them. Spec annex D.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace slf {

/// Luma of R, G, B. ITU-R BT.709.
template <class T>
double luma(const T& rgb) {
  return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
}

/// Squared errors of 8-bit values per channel and of luma, and how many values each has.
struct ErrorSum {
  std::array<double, 3> squares{};
  double luma_squares = 0;
  std::uint64_t count = 0;

  void add(const std::array<double, 3>& error) {
    for (std::size_t k = 0; k < 3; ++k) squares[k] += error[k] * error[k];
    luma_squares += luma(error) * luma(error);
    ++count;
  }
  void add_all(const ErrorSum& other) {
    for (std::size_t k = 0; k < 3; ++k) squares[k] += other.squares[k];
    luma_squares += other.luma_squares;
    count += other.count;
  }
  double total() const { return squares[0] + squares[1] + squares[2]; }
  double luma_psnr() const { return psnr(luma_squares, count); }
  double channel_psnr(std::size_t k) const { return psnr(squares[k], count); }
  double psnr() const { return psnr(total(), 3 * count); }

 private:
  /// Infinite where nothing differs; NaN where nothing was compared.
  static double psnr(double squares, std::uint64_t count) {
    if (count == 0) return std::numeric_limits<double>::quiet_NaN();
    return 10 * std::log10(255.0 * 255.0 * static_cast<double>(count) / squares);
  }
};

}  // namespace slf
