// SPDX-License-Identifier: Apache-2.0
// Binary arithmetic decoder. Spec 8.3.1.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "entropy/adaptive_bit.h"
#include "slf/error.h"

namespace slf {

/// Decodes what RangeEncoder wrote. Bytes past the end read as zero, but at most four of them can
/// be needed by a sound codeword: exhausted() and finish() tell. Loops over decoded symbols must be
/// bounded by counts, and long ones stop when the codeword is exhausted.
class RangeDecoder {
 public:
  static constexpr bool kDecodes = true;

  explicit RangeDecoder(std::span<const std::uint8_t> bytes) : bytes_(bytes) {
    for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next_byte();
  }

  /// One decision with P(1) = p1 / 65536, 1 <= p1 <= 65535. The argument `bit` is ignored: the
  /// encoder has the same signature, so that one description of a payload serves both.
  unsigned bit(std::uint32_t p1, unsigned = 0) {
    // Invariant: code_ < range_ and 2^24 <= range_, so 0 < bound < range_.
    const std::uint32_t bound = (range_ >> kProbabilityBits) * p1;
    const unsigned value = code_ < bound;
    const std::uint32_t one =
        0u - value;  // a mask: most decisions are hard to foresee for a branch
    code_ -= bound & ~one;
    range_ = (bound & one) | ((range_ - bound) & ~one);
    while (range_ < kMinRange) {
      range_ <<= 8;
      code_ = code_ << 8 | next_byte();
    }
    return value;
  }

  unsigned bit(AdaptiveBit& context, std::uint32_t limit, unsigned = 0) {
    const unsigned value = bit(context.p1());
    context.update(value, limit);
    return value;
  }

  /// n equiprobable bits, most significant first; n <= 32.
  std::uint32_t raw(int n, std::uint32_t = 0) {
    std::uint32_t value = 0;
    for (int i = 0; i < n; ++i) value = value << 1 | bit(1u << (kProbabilityBits - 1));
    return value;
  }

  /// More was read than a sound codeword needs: what is decoded from here on is of no meaning.
  bool exhausted() const { return pos_ > bytes_.size() + 4; }

  /// An error of what was decoded last: at the byte of the codeword that would be read next.
  Error here(Errc code, const char* element) const {
    return {code, element, 8 * std::uint64_t{std::min(pos_, bytes_.size())}};
  }

  /// Ends the codeword: all bytes were used and none beyond the four of the register.
  Result<Done> finish(const char* element) const {
    if (pos_ < bytes_.size()) return here(Errc::kOutOfRange, element);
    if (exhausted()) return here(Errc::kTruncated, element);
    return Done{};
  }

 private:
  static constexpr std::uint32_t kMinRange = 1u << 24;

  std::uint32_t next_byte() {
    const std::uint32_t byte = pos_ < bytes_.size() ? bytes_[pos_] : 0;
    ++pos_;
    return byte;
  }

  std::span<const std::uint8_t> bytes_;
  std::size_t pos_ = 0;  // bytes consumed, those past the end counted
  std::uint32_t code_ = 0;
  std::uint32_t range_ = 0xFFFFFFFFu;
};

}  // namespace slf
