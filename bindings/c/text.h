// SPDX-License-Identifier: Apache-2.0
// Short texts without a format string, allocation or locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace slf::capi {

/// Fills an array of characters; what does not fit is cut. There is always a zero at the end.
class Text {
 public:
  explicit Text(std::span<char> to) : to_(to) { to_[0] = 0; }

  Text& operator<<(const char* text) {
    for (; *text != 0 && at_ + 1 < to_.size(); ++text) to_[at_++] = *text;
    to_[at_] = 0;
    return *this;
  }
  Text& operator<<(std::uint64_t number) {
    char digits[21] = {};
    char* first = digits + 20;
    do {
      *--first = static_cast<char>('0' + number % 10);
      number /= 10;
    } while (number > 0);
    return *this << first;
  }

 private:
  std::span<char> to_;
  std::size_t at_ = 0;
};

}  // namespace slf::capi
