// SPDX-License-Identifier: Apache-2.0
// Mirror of entropy/range_decoder.h. Spec 8.3.1 (the encoder is informative).
#pragma once

#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"

namespace slf {

class RangeEncoder {
 public:
  static constexpr bool kDecodes = false;

  unsigned bit(std::uint32_t p1, unsigned value) {
    const std::uint32_t bound = (range_ >> kProbabilityBits) * p1;
    if (value) {
      range_ = bound;
    } else {
      low_ += bound;
      range_ -= bound;
    }
    while (range_ < kMinRange) {
      range_ <<= 8;
      shift_low();
    }
    return value;
  }

  unsigned bit(AdaptiveBit& context, std::uint32_t limit, unsigned value) {
    bit(context.p1(), value);
    context.update(value, limit);
    return value;
  }

  std::uint32_t raw(int n, std::uint32_t value) {
    for (int i = n - 1; i >= 0; --i) bit(1u << (kProbabilityBits - 1), value >> i & 1u);
    return value;
  }

  /// The codeword, as short as a decoder that reads zeros past the end allows. Empty only where
  /// there was no decision.
  std::vector<std::uint8_t> finish() {
    const std::size_t least = range_ == kFullRange ? 0 : 1;
    // Any value in [low, low + range) will do: take the one with most trailing zero bytes.
    for (int zeros = 3; zeros > 0; --zeros) {
      const std::uint64_t mask = (std::uint64_t{1} << (8 * zeros)) - 1;
      const std::uint64_t value = (low_ + mask) & ~mask;
      if (value < low_ + range_) {
        low_ = value;
        break;
      }
    }
    for (int i = 0; i < 5; ++i) shift_low();
    bytes_.erase(bytes_.begin());  // the first byte holds only a carry that cannot happen
    // The decoder's register holds four bytes: no more of them may be left to its zeros.
    for (int i = 0; i < 4 && bytes_.size() > least && bytes_.back() == 0; ++i) bytes_.pop_back();
    return std::move(bytes_);
  }

 private:
  static constexpr std::uint32_t kMinRange = 1u << 24;
  static constexpr std::uint32_t kFullRange = 0xFFFFFFFFu;  // that no decision leaves

  // A byte leaves only when no carry can reach it any more: 0xFF bytes wait.
  void shift_low() {
    if (low_ < 0xFF000000u || low_ > 0xFFFFFFFFu) {
      const auto carry = static_cast<std::uint8_t>(low_ >> 32);
      bytes_.push_back(static_cast<std::uint8_t>(held_ + carry));
      for (; waiting_ > 0; --waiting_) bytes_.push_back(static_cast<std::uint8_t>(0xFF + carry));
      held_ = static_cast<std::uint8_t>(low_ >> 24);
    } else {
      ++waiting_;
    }
    low_ = (low_ & 0x00FFFFFFu) << 8;
  }

  std::uint64_t low_ = 0;
  std::uint32_t range_ = kFullRange;
  std::uint8_t held_ = 0;
  std::uint64_t waiting_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace slf
