// SPDX-License-Identifier: Apache-2.0
// The state of one context of a mixed decision, in 16 bits. Spec 8.3.5.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/eight_lanes.h"
#include "entropy/logistic.h"

namespace slf {

/// The numbers of a context's states: by decisions seen, up to 14, and how many of them were 1;
/// then by P(1) of 4096.
struct ContextStates {
  static constexpr std::uint32_t kCounts = 15;
  static constexpr std::uint32_t counted(std::uint32_t seen, std::uint32_t ones) {
    return seen * (seen + 1) / 2 + ones;
  }
  static constexpr std::uint32_t kFirstMoved = kCounts * (kCounts + 1) / 2;
  static constexpr std::uint32_t kAll = kFirstMoved + 4096;

  /// (ones + 1/4) / (seen + 1/2) of 4096, to nearest.
  static constexpr std::uint32_t probability(std::uint32_t seen, std::uint32_t ones) {
    return (4096 * (4 * ones + 1) + 2 * seen + 1) / (4 * seen + 2);
  }
  static constexpr std::uint16_t of(std::uint32_t seen, std::uint32_t ones) {
    return static_cast<std::uint16_t>(seen < kCounts ? counted(seen, ones)
                                                     : kFirstMoved + probability(seen, ones));
  }
  /// A decision moves P(1) by 1/16.5 of the error.
  static constexpr std::uint16_t moved(std::int32_t p, std::int32_t bit) {
    constexpr std::int32_t kRate = 3972;  // of 65536
    p += ((bit * 4095 - p) * kRate + (1 << 15)) >> 16;
    return static_cast<std::uint16_t>(kFirstMoved + static_cast<std::uint32_t>(p));
  }
};

/// The state after a 0 and after a 1.
SLF_TABLE std::array<std::array<std::uint16_t, 2>, ContextStates::kAll> kContextNext = [] {
  SLF_TABLE_BEGINS;
  std::array<std::array<std::uint16_t, 2>, ContextStates::kAll> table{};
  auto next = table.begin();
  for (std::uint32_t seen = 1; seen <= ContextStates::kCounts; ++seen)
    for (std::uint32_t ones = 0; ones < seen; ++ones)
      *next++ = {ContextStates::of(seen, ones), ContextStates::of(seen, ones + 1)};
  for (std::int32_t p = 0; p < 4096; ++p)
    *next++ = {ContextStates::moved(p, 0), ContextStates::moved(p, 1)};
  return table;
}();

/// stretch of P(1); 0 of one half, which is what a context never seen has.
SLF_TABLE std::array<std::int16_t, ContextStates::kAll> kContextInput = [] {
  SLF_TABLE_BEGINS;
  std::array<std::int16_t, 4096> of = kStretch;
  of[2048] = 0;
  std::array<std::int16_t, ContextStates::kAll> table{};
  auto input = table.begin();
  for (std::uint32_t seen = 0; seen < ContextStates::kCounts; ++seen)
    for (std::uint32_t ones = 0; ones <= seen; ++ones)
      *input++ = of[ContextStates::probability(seen, ones)];
  std::copy(of.begin(), of.end(), input);
  return table;
}();

/// One of 4,216 states. The first tell how many decisions were seen, up to 14, and how many of them
/// were 1: P(1) is (ones + 1/4) / (seen + 1/2). Then P(1) itself, in 12 fractional bits, of which
/// every decision moves 1/16.5 of the error.
class ContextBit {
 public:
  /// What a mixer is given.
  std::int16_t logistic() const { return kContextInput[state_]; }

  void update(unsigned bit) { state_ = kContextNext[state_][bit]; }

 private:
  std::uint16_t state_ = 0;
};

/// The contexts of one decision, none twice: read and moved together.
/// kBehind: how many of them, the last, stand behind the constant.
template <std::size_t kCount, std::size_t kBehind = 0>
class SelectedContexts {
 public:
  static_assert(kCount < EightLanes::kCount);
  static constexpr std::size_t kConstant = kCount - kBehind;  ///< lane of it

  /// contexts: kept by reference. next: how far behind them the contexts are.
  explicit SelectedContexts(const std::array<ContextBit*, kCount>& contexts, std::size_t next = 0)
      : contexts_(contexts), next_(next) {
    std::array<std::int16_t, EightLanes::kCount> inputs{};
    for (std::size_t i = 0; i < kCount; ++i)
      inputs[i < kConstant ? i : i + 1] = contexts_[i][next_].logistic();
    inputs[kConstant] = 256;
    inputs_ = EightLanes(inputs);
  }

  /// What a mixer is given: the contexts', and a constant.
  EightLanes inputs() const { return inputs_; }

  /// As ContextBit::update of each.
  void update(unsigned bit) const {
    for (ContextBit* context : contexts_) context[next_].update(bit);
  }

 private:
  const std::array<ContextBit*, kCount>& contexts_;  // a copy would go through memory
  std::size_t next_;
  EightLanes inputs_;
};

}  // namespace slf
