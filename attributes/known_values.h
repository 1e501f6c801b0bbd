// SPDX-License-Identifier: Apache-2.0
// What a finer layer knows of values by the layers before it. Spec 8.7.7.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace slf {

/// In the decoder the array still has the values of the layers before, in the encoder those after.
class KnownValues {
 public:
  explicit KnownValues(bool refines) : refines_(refines) {}

  bool refines() const { return refines_; }

  /// What a value is by the layers before; 0 where there are none.
  template <class Coder>
  std::int32_t value(std::int32_t v) const {
    return !refines_ ? 0 : Coder::kDecodes ? v : v / 2;
  }

  /// Is a function's vector known not to be zero?
  template <class Coder>
  bool any(const std::int32_t* values) const {
    return refines_ &&
           (value<Coder>(values[0]) | value<Coder>(values[1]) | value<Coder>(values[2])) != 0;
  }

  /// Behind the last of the functions that is known not to be zero; 0: none is.
  template <class Coder>
  std::size_t end(const std::int32_t* row, const std::vector<std::uint16_t>& functions) const {
    if (!refines_) return 0;
    std::size_t end = functions.size();
    while (end > 0 && !any<Coder>(row + 3u * functions[end - 1])) --end;
    return end;
  }

 private:
  bool refines_;
};

}  // namespace slf
