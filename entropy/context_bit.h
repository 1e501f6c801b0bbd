// The state of one context of a mixed decision, in 16 bits. Spec 8.3.5.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "entropy/eight_lanes.h"
#include "entropy/logistic.h"

namespace slf {

/// P(bit = 1) in 12 fractional bits and the number of decisions seen, at most 15, in 4. The n-th
/// decision moves the probability by 1/(n + 1.5) of the error: the mean of what was seen at first,
/// forgetting afterwards.
class ContextBit {
 public:
  /// What a mixer is given.
  std::int16_t logistic() const { return kInput[state_ >> 4]; }

  void update(unsigned bit) {
    const std::uint32_t n = state_ & 15;
    const std::int32_t target = static_cast<std::int32_t>(0u - bit) & 0xFFF0;
    const std::int32_t error = target - static_cast<std::int32_t>(state_ & 0xFFF0u);
    const std::int32_t step = ((error * kRate[n] + (1 << 19)) >> 20) * 16;
    state_ = static_cast<std::uint16_t>(static_cast<std::int32_t>(state_) + step + kSeen[n]);
  }

 private:
  template <std::size_t kCount>
  friend class SelectedContexts;

  /// round(65536 / (n + 1.5)). Spec table 8-1.
  static constexpr std::array<std::int32_t, 16> kRate = [] {
    std::array<std::int32_t, 16> table{};
    for (int n = 0; n < 16; ++n)
      table[static_cast<std::size_t>(n)] = (131072 + (2 * n + 3) / 2) / (2 * n + 3);
    return table;
  }();
  static constexpr std::array<std::int32_t, 16> kSeen = {1, 1, 1, 1, 1, 1, 1, 1,
                                                         1, 1, 1, 1, 1, 1, 1, 0};
  /// stretch of the probability; 0 of one half, which is what a context never seen has.
  SLF_TABLE_MEMBER std::array<std::int16_t, 4096> kInput = [] {
    SLF_TABLE_BEGINS;
    std::array<std::int16_t, 4096> table = kStretch;
    table[2048] = 0;
    return table;
  }();

  std::uint16_t state_ = 1u << 15;
};

/// The contexts of one decision, none twice: read and moved together.
template <std::size_t kCount>
class SelectedContexts {
 public:
  static_assert(kCount < EightLanes::kCount);

  /// contexts: kept by reference. next: how far behind them the contexts are.
  explicit SelectedContexts(const std::array<ContextBit*, kCount>& contexts, std::size_t next = 0)
      : contexts_(contexts), next_(next) {
    std::array<std::int16_t, EightLanes::kCount> inputs{};
    for (std::size_t i = 0; i < kCount; ++i) inputs[i] = contexts_[i][next_].logistic();
    inputs[kCount] = 256;
    inputs_ = EightLanes(inputs);
#if defined(__SSE2__)
    gather(std::make_index_sequence<kCount>{});
#endif
  }

  /// What a mixer is given: the contexts', and a constant.
  EightLanes inputs() const { return inputs_; }

  /// As ContextBit::update of each.
  void update(unsigned bit) const {
#if defined(__SSE2__)
    store(moved(states_, rates_, bit), std::make_index_sequence<kCount>{});
#else
    for (ContextBit* context : contexts_) context[next_].update(bit);
#endif
  }

 private:
#if defined(__SSE2__)
  /// The distance to the target has 12 bits, its product with the rate 28: half of it is rounded as
  /// ContextBit rounds the negative number, towards where it came from.
  static __m128i moved(__m128i state, __m128i rate, unsigned bit) {
    const __m128i zero = _mm_set1_epi16(static_cast<short>(bit - 1));  // all ones, or none, for a 1
    const __m128i fifteen = _mm_set1_epi16(15);
    const __m128i distance =
        _mm_xor_si128(_mm_srli_epi16(state, 4), _mm_andnot_si128(zero, _mm_set1_epi16(0xFFF)));
    const __m128i low = _mm_subs_epu16(_mm_mullo_epi16(distance, rate), _mm_srli_epi16(zero, 15));
    const __m128i step =
        _mm_slli_epi16(_mm_add_epi16(_mm_mulhi_epu16(distance, rate), _mm_srli_epi16(low, 15)), 4);
    const __m128i many = _mm_cmpeq_epi16(_mm_and_si128(state, fifteen), fifteen);
    const __m128i seen = _mm_add_epi16(_mm_add_epi16(state, _mm_set1_epi16(1)), many);
    return _mm_add_epi16(seen, _mm_sub_epi16(_mm_xor_si128(step, zero), zero));
  }

  /// Lane by lane: what is known by then needs no place in memory.
  template <std::size_t... i>
  void gather(std::index_sequence<i...>) {
    ((states_ = _mm_insert_epi16(states_, contexts_[i][next_].state_, static_cast<int>(i)),
      rates_ = _mm_insert_epi16(rates_, ContextBit::kRate[contexts_[i][next_].state_ & 15],
                                static_cast<int>(i))),
     ...);
  }

  template <std::size_t... i>
  void store(__m128i states, std::index_sequence<i...>) const {
    ((contexts_[i][next_].state_ =
          static_cast<std::uint16_t>(_mm_extract_epi16(states, static_cast<int>(i)))),
     ...);
  }
#endif

  const std::array<ContextBit*, kCount>& contexts_;  // a copy would go through memory
  std::size_t next_;
  EightLanes inputs_;
#if defined(__SSE2__)
  __m128i states_ = _mm_setzero_si128(), rates_ = _mm_setzero_si128();
#endif
};

}  // namespace slf
