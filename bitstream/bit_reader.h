// SPDX-License-Identifier: Apache-2.0
// Bits of one unit, most significant first. Spec 3.3.
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <span>

#include "slf/error.h"

namespace slf {

/// Cannot read outside its bytes and cannot spin: the first failure sticks, later reads give 0.
class BitReader {
 public:
  explicit BitReader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  std::uint64_t u(int n, const char* element) {  // 0 <= n <= 64
    assert(n >= 0 && n <= 64);
    if (failed_ || static_cast<std::uint64_t>(n) > bits_left())
      return fail(Errc::kTruncated, element);
    std::uint64_t value = 0;
    for (int i = 0; i < n; ++i, ++pos_)
      value = value << 1 | (bytes_[pos_ / 8] >> (7 - pos_ % 8) & 1u);
    return value;
  }

  /// Exp-Golomb, 0 .. 2^32 - 2. A run of 32 zeros is no valid code: it fails, it does not spin.
  std::uint64_t ue(const char* element) {
    const std::uint64_t begin = pos_;
    int zeros = 0;
    while (u(1, element) == 0)
      if (failed_ || ++zeros == 32) return fail(Errc::kOutOfRange, element, begin);
    const std::uint64_t suffix = u(zeros, element);
    return failed_ ? 0 : (std::uint64_t{1} << zeros) - 1 + suffix;
  }

  /// Signed Exp-Golomb: 0, 1, -1, 2, -2, ... for ue 0, 1, 2, 3, 4, ...
  std::int64_t se(const char* element) {
    const auto code = static_cast<std::int64_t>(ue(element));
    return code % 2 != 0 ? code / 2 + 1 : -(code / 2);
  }

  double f64(const char* element) { return std::bit_cast<double>(u(64, element)); }

  /// Fewer than 8 bits may follow, all zero. Spec 3.3.
  void trailing_bits(const char* element) {
    if (!failed_ && bits_left() >= 8) fail(Errc::kOutOfRange, element);
    const std::uint64_t begin = pos_;
    if (!failed_ && u(static_cast<int>(bits_left()), element) != 0)
      fail(Errc::kReserved, element, begin);
  }

  /// Skips zero bits to the next byte.
  void align(const char* element) {
    const std::uint64_t begin = pos_;
    const int padding = static_cast<int>((8 - pos_ % 8) % 8);
    if (u(padding, element) != 0) fail(Errc::kReserved, element, begin);
  }

  /// The same, and returns the bytes that follow.
  std::span<const std::uint8_t> align_and_rest(const char* element) {
    align(element);
    return failed_ ? std::span<const std::uint8_t>{} : bytes_.subspan(pos_ / 8);
  }

  void skip_all() { pos_ = bits(); }

  /// Fails at the bit where `begin` says, or at the next one to read.
  std::uint64_t fail(Errc code, const char* element, std::uint64_t begin) {
    if (!failed_) error_ = {code, element, begin};
    failed_ = true;
    return 0;
  }
  std::uint64_t fail(Errc code, const char* element) { return fail(code, element, pos_); }

  bool ok() const { return !failed_; }
  const Error& error() const { return error_; }
  std::uint64_t bit_position() const { return pos_; }
  std::uint64_t bits_left() const { return bits() - pos_; }

 private:
  /// In 64 bits: a size of 32 bits cannot count the bits of 512 MiB.
  std::uint64_t bits() const { return std::uint64_t{bytes_.size()} * 8; }

  std::span<const std::uint8_t> bytes_;
  std::uint64_t pos_ = 0;  // bits consumed
  bool failed_ = false;
  Error error_;
};

}  // namespace slf
