// SPDX-License-Identifier: Apache-2.0
// Mirror of bitstream/bit_reader.h. Spec 3.3.
#pragma once

#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace slf {

class BitWriter {
 public:
  void u(int n, std::uint64_t value) {
    assert(n >= 0 && n <= 64 && (n == 64 || value >> n == 0));
    for (int i = n - 1; i >= 0; --i, ++pos_) {
      if (pos_ % 8 == 0) bytes_.push_back(0);
      bytes_.back() =
          static_cast<std::uint8_t>(bytes_.back() | (value >> i & 1u) << (7 - pos_ % 8));
    }
  }

  void ue(std::uint64_t value) {  // 0 .. 2^32 - 2
    const auto length = static_cast<int>(std::bit_width(value + 1));
    assert(length <= 32);
    u(length - 1, 0);
    u(length, value + 1);
  }

  void se(std::int64_t value) {  // |value| < 2^31
    ue(static_cast<std::uint64_t>(value > 0 ? 2 * value - 1 : -2 * value));
  }

  void f64(double value) { u(64, std::bit_cast<std::uint64_t>(value)); }

  void align() { pos_ = bytes_.size() * 8; }  // the padding bits are zero already

  void append(std::span<const std::uint8_t> bytes) {
    align();
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    pos_ = bytes_.size() * 8;
  }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_;
  std::uint64_t pos_ = 0;  // bits written
};

}  // namespace slf
