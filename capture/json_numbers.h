// SPDX-License-Identifier: Apache-2.0
// Vectors, matrices and sizes out of JSON.
#pragma once

#include <array>
#include <cmath>

#include "capture/json.h"

namespace slf {

/// A tree takes up to 30 times the bytes of its text.
inline constexpr std::uint64_t kMaxJsonBytes = std::uint64_t{64} << 20;

template <std::size_t N>
Result<std::array<double, N>, InputError> json_vector(const JsonView& json) {
  SLF_TRY(const auto items, json.items(N));
  std::array<double, N> values{};
  for (std::size_t i = 0; i < N; ++i) {
    SLF_TRY(values[i], items[i].number());
  }
  return values;
}

/// Rows of columns.
template <std::size_t Rows, std::size_t Columns>
Result<std::array<std::array<double, Columns>, Rows>, InputError> json_matrix(
    const JsonView& json) {
  SLF_TRY(const auto items, json.items(Rows));
  std::array<std::array<double, Columns>, Rows> values{};
  for (std::size_t i = 0; i < Rows; ++i) {
    SLF_TRY(values[i], json_vector<Columns>(items[i]));
  }
  return values;
}

/// A side of an image: a whole number, 1 .. 65535. Some writers have 800.0.
inline Result<int, InputError> json_size(const JsonView& json) {
  SLF_TRY(const double value, json.number());
  if (!(value >= 1 && value <= 65535) || value != std::floor(value))
    return json.error("an image has a whole number of pixels, 1 .. 65535, along each side");
  return static_cast<int>(value);
}

}  // namespace slf
