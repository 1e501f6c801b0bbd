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

  /// The values of a function by which the layers before are known: zeros where there are none, so
  /// that a decoder never waits for what it only writes.
  const std::int32_t* of(const std::int32_t* values) const {
    static constexpr std::int32_t kNone[3] = {};
    return refines_ ? values : kNone;
  }

  /// What a value is by the layers before. v: an element of of()
  template <class Coder>
  static std::int32_t value(std::int32_t v) {
    return Coder::kDecodes ? v : v / 2;
  }

  /// Is a function's vector known not to be zero? values: of()
  template <class Coder>
  static bool any(const std::int32_t* values) {
    return (value<Coder>(values[0]) | value<Coder>(values[1]) | value<Coder>(values[2])) != 0;
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
