// SPDX-License-Identifier: Apache-2.0
// The contexts of a decision, declared by what selects them: index and size come from one place.
#pragma once

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace slf {

/// One context for every combination of values 0 .. size - 1; the last value moves fastest.
/// ContextShape<5, 3> has 15, and index(a, b) is 3 a + b.
template <std::uint32_t... kSizes>
struct ContextShape {
  static constexpr std::uint32_t kCount = (1u * ... * kSizes);
  /// The largest value in a place.
  template <std::size_t kPlace>
  static constexpr std::uint32_t kMost = std::array{kSizes...}[kPlace] - 1;

  template <class... Values>
  static constexpr std::uint32_t index(Values... values) {
    static_assert(sizeof...(Values) == sizeof...(kSizes));
    assert(((static_cast<std::uint32_t>(values) < kSizes) && ...));
    std::uint32_t index = 0;
    ((index = index * kSizes + static_cast<std::uint32_t>(values)), ...);
    return index;
  }
};

}  // namespace slf
