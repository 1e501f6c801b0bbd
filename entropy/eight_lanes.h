// SPDX-License-Identifier: Apache-2.0
// Eight 16-bit integers that are worked on together: inputs and weights of a mixer. Spec 8.3.3.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#if defined(__SSE2__)
#include <emmintrin.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

namespace slf {

/// The operations are those of every 8-lane 16-bit unit. Without one that is known here the same
/// integers come from loops. All have wrapping, or where it says so saturating, semantics.
class EightLanes {
 public:
  static constexpr std::size_t kCount = 8;

#if defined(__SSE2__)
  EightLanes() : v_(_mm_setzero_si128()) {}
  explicit EightLanes(std::int16_t every) : v_(_mm_set1_epi16(every)) {}
  explicit EightLanes(const std::array<std::int16_t, kCount>& x)
      : v_(_mm_set_epi16(x[7], x[6], x[5], x[4], x[3], x[2], x[1], x[0])) {}

  EightLanes saturating_plus(EightLanes o) const { return EightLanes(_mm_adds_epi16(v_, o.v_)); }

  /// Sum of products. It must fit 32 bits.
  std::int32_t dot(EightLanes o) const {
    __m128i sum = _mm_madd_epi16(v_, o.v_);
    sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0x4E));
    sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, 0xB1));
    return _mm_cvtsi128_si32(sum);
  }

  /// Per lane (x * factor + 2^15) >> 16, factor within -2^14 .. 2^14 - 1.
  EightLanes times(std::int32_t factor) const {
    const __m128i high = _mm_mulhi_epi16(v_, _mm_set1_epi16(static_cast<std::int16_t>(2 * factor)));
    return EightLanes(_mm_srai_epi16(_mm_add_epi16(high, _mm_set1_epi16(1)), 1));
  }

  __m128i vector() const { return v_; }

  std::array<std::int16_t, kCount> values() const {
    std::array<std::int16_t, kCount> x;
    _mm_storeu_si128(reinterpret_cast<__m128i*>(x.data()), v_);
    return x;
  }

 private:
  explicit EightLanes(__m128i v) : v_(v) {}
  __m128i v_;
#elif defined(__wasm_simd128__)
  EightLanes() : v_(wasm_i16x8_const_splat(0)) {}
  explicit EightLanes(std::int16_t every) : v_(wasm_i16x8_splat(every)) {}
  explicit EightLanes(const std::array<std::int16_t, kCount>& x)
      : v_(wasm_i16x8_make(x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7])) {}

  EightLanes saturating_plus(EightLanes o) const {
    return EightLanes(wasm_i16x8_add_sat(v_, o.v_));
  }

  std::int32_t dot(EightLanes o) const {
    v128_t sum = wasm_i32x4_dot_i16x8(v_, o.v_);
    sum = wasm_i32x4_add(sum, wasm_i32x4_shuffle(sum, sum, 2, 3, 0, 1));
    sum = wasm_i32x4_add(sum, wasm_i32x4_shuffle(sum, sum, 1, 0, 3, 2));
    return wasm_i32x4_extract_lane(sum, 0);
  }

  EightLanes times(std::int32_t factor) const {
    const v128_t by = wasm_i16x8_splat(static_cast<std::int16_t>(factor));
    const v128_t half = wasm_i32x4_const_splat(1 << 15);
    const v128_t low = wasm_i32x4_add(wasm_i32x4_extmul_low_i16x8(v_, by), half);
    const v128_t high = wasm_i32x4_add(wasm_i32x4_extmul_high_i16x8(v_, by), half);
    return EightLanes(wasm_i16x8_narrow_i32x4(wasm_i32x4_shr(low, 16), wasm_i32x4_shr(high, 16)));
  }

  v128_t vector() const { return v_; }

  std::array<std::int16_t, kCount> values() const {
    std::array<std::int16_t, kCount> x;
    wasm_v128_store(x.data(), v_);
    return x;
  }

 private:
  explicit EightLanes(v128_t v) : v_(v) {}
  v128_t v_;
#else
  EightLanes() : v_{} {}
  explicit EightLanes(std::int16_t every) { v_.fill(every); }
  explicit EightLanes(const std::array<std::int16_t, kCount>& x) : v_(x) {}

  EightLanes saturating_plus(EightLanes o) const {
    EightLanes sum;
    for (std::size_t i = 0; i < kCount; ++i) {
      const std::int32_t s = v_[i] + o.v_[i];
      sum.v_[i] = static_cast<std::int16_t>(s < -32768 ? -32768 : s > 32767 ? 32767 : s);
    }
    return sum;
  }

  std::int32_t dot(EightLanes o) const {
    std::int32_t sum = 0;
    for (std::size_t i = 0; i < kCount; ++i) sum += std::int32_t{v_[i]} * o.v_[i];
    return sum;
  }

  EightLanes times(std::int32_t factor) const {
    EightLanes product;
    for (std::size_t i = 0; i < kCount; ++i)
      product.v_[i] = static_cast<std::int16_t>((v_[i] * factor + (1 << 15)) >> 16);
    return product;
  }

  std::array<std::int16_t, kCount> values() const { return v_; }

 private:
  std::array<std::int16_t, kCount> v_;
#endif
};

}  // namespace slf
