// SPDX-License-Identifier: Apache-2.0
// What quantised coefficients will cost, roughly, for the encoder's choices. Informative.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace slf {

/// log2(n) in 256ths, rounded down; integers, so that every machine chooses alike. n >= 1.
inline std::uint32_t log2_q8(std::uint64_t n) {
  const auto whole = static_cast<std::uint32_t>(std::bit_width(n)) - 1;
  std::uint64_t x = whole > 31 ? n >> (whole - 31) : n << (31 - whole);  // 1 .. 2, 31 bits
  std::uint32_t log = whole;
  for (int i = 0; i < 8; ++i) {
    x = (x * x) >> 31;
    const std::uint64_t carry = x >> 32;
    log = log << 1 | static_cast<std::uint32_t>(carry);
    x >>= carry;
  }
  return log;
}

/// An adaptive decision: its probability in 16 bits, moving 1/32 of the way.
class AdaptiveCost {
 public:
  explicit AdaptiveCost(std::uint32_t one = 4096) : one_(one) {}

  /// In 256ths of a bit.
  std::uint32_t of(bool bit) const { return table()[(bit ? one_ : 65536 - one_) >> 7]; }
  void update(bool bit) {
    const std::uint32_t target = bit ? 65536 - 64 : 64;
    one_ += (target >> 5) - (one_ >> 5);
  }

 private:
  static const std::array<std::uint16_t, 513>& table() {
    static const auto costs = [] {
      std::array<std::uint16_t, 513> t{};
      for (std::uint32_t i = 0; i < t.size(); ++i)
        t[i] = static_cast<std::uint16_t>(17 * 256 - log2_q8(2 * (i * 128 + 64)));
      return t;
    }();
    return costs;
  }
  std::uint32_t one_;
};

/// Statistics of one plane group, much as the vector coder's (8.7.2): is a node zero, a block of
/// eight functions (of four, there), a value; then its magnitude.
class RateModel {
 public:
  static constexpr std::size_t kBlock = 24;  // planes

  explicit RateModel(std::size_t planes) : value_(planes * 3) {}

  AdaptiveCost& node(std::uint32_t parent_count, std::uint32_t before) {
    return node_[few(parent_count) * 3 + few(before)];
  }
  AdaptiveCost& block(std::size_t block, bool parent_any, bool begun) {
    return block_[(std::min<std::size_t>(block, 15) * 2 + parent_any) * 2 + begun];
  }
  AdaptiveCost& value(std::size_t plane, std::int32_t parent) {
    return value_[plane * 3 + size_of(parent)];
  }
  /// Cost of a magnitude above 0, with its sign.
  std::uint32_t magnitude_cost(std::uint32_t magnitude, std::int32_t parent) const {
    const auto& more = more_[size_of(parent)];
    std::uint32_t cost = 256;
    for (std::uint32_t i = 0; i < more.size(); ++i) {
      cost += more[i].of(magnitude > i + 1);
      if (magnitude <= i + 1) return cost;
    }
    return cost + 512 * log2_q8(magnitude - 2) / 256 + 256;
  }
  void update_magnitude(std::uint32_t magnitude, std::int32_t parent) {
    auto& more = more_[size_of(parent)];
    for (std::uint32_t i = 0; i < more.size(); ++i) {
      more[i].update(magnitude > i + 1);
      if (magnitude <= i + 1) return;
    }
  }

 private:
  static std::size_t few(std::uint32_t count) { return count == 0 ? 0 : count < 3 ? 1 : 2; }
  static std::size_t size_of(std::int32_t value) {
    return value == 0 ? 0 : value == 1 || value == -1 ? 1 : 2;
  }

  std::array<AdaptiveCost, 9> node_;
  std::array<AdaptiveCost, 64> block_;
  std::vector<AdaptiveCost> value_;
  std::array<std::array<AdaptiveCost, 3>, 3> more_;
};

}  // namespace slf
