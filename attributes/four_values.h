// SPDX-License-Identifier: Apache-2.0
// Values of a row one at a time or four together: what loops over planes do to a value is written
// once, and in WebAssembly, where compilers find no good vectors for products of 64 bits, for both.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#if defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif

#include "base/multiversion.h"

namespace slf {

/// Value j of a row.
inline std::int32_t value_at(const std::int32_t* row, std::size_t j) { return row[j]; }
inline void set_value(std::int32_t* row, std::size_t j, std::int32_t value) { row[j] = value; }

inline std::int64_t product(std::int32_t a, std::int32_t b) { return std::int64_t{a} * b; }

/// x / 2^bits rounded to nearest, ties away from zero. The result has 32 bits, so the sign bits
/// that a logical shift loses are not part of it; AVX2 has no other for 64 bits.
template <int bits>
constexpr std::int32_t rounded(std::int64_t x) {
  const auto sum = static_cast<std::uint64_t>(x) + (std::uint64_t{1} << (bits - 1));
  return static_cast<std::int32_t>((sum - (static_cast<std::uint64_t>(x) >> 63)) >> bits);
}

constexpr std::int32_t limited(std::int32_t x, std::int32_t most) {
  return std::clamp(x, -most, most);
}

/// Not 0: some of them differ.
constexpr std::int32_t differ(std::int32_t a, std::int32_t b) { return a ^ b; }

#if defined(__wasm_simd128__)

/// The place of values j .. j + 3.
struct FourPlaces {
  std::size_t j;
};

class FourValues {
 public:
  explicit FourValues(v128_t values) : v(values) {}
  FourValues(std::int32_t every) : v(wasm_i32x4_splat(every)) {}
  FourValues operator+(FourValues o) const { return FourValues(wasm_i32x4_add(v, o.v)); }
  FourValues operator-(FourValues o) const { return FourValues(wasm_i32x4_sub(v, o.v)); }
  FourValues operator*(FourValues o) const { return FourValues(wasm_i32x4_mul(v, o.v)); }

  v128_t v;
};

struct FourProducts {
  v128_t low, high;
  FourProducts operator+(const FourProducts& o) const {
    return {wasm_i64x2_add(low, o.low), wasm_i64x2_add(high, o.high)};
  }
  FourProducts operator-(const FourProducts& o) const {
    return {wasm_i64x2_sub(low, o.low), wasm_i64x2_sub(high, o.high)};
  }
};

inline FourValues value_at(const std::int32_t* row, FourPlaces at) {
  return FourValues(wasm_v128_load(row + at.j));
}
inline void set_value(std::int32_t* row, FourPlaces at, FourValues value) {
  wasm_v128_store(row + at.j, value.v);
}

SLF_IN_LINE FourProducts product(FourValues a, FourValues b) {
  return {wasm_i64x2_extmul_low_i32x4(a.v, b.v), wasm_i64x2_extmul_high_i32x4(a.v, b.v)};
}

/// 1 for the negative ones. In two steps: of a single one compilers make an arithmetic shift, and
/// that takes processors five.
SLF_IN_LINE v128_t is_negative(v128_t products) {
  return wasm_u64x2_shr(wasm_u32x4_shr(products, 31), 32);
}

template <int bits>
SLF_IN_LINE FourValues rounded(const FourProducts& x) {
  const v128_t half = wasm_i64x2_const_splat(std::int64_t{1} << (bits - 1));
  const auto down = [&](v128_t y) {
    return wasm_u64x2_shr(wasm_i64x2_sub(wasm_i64x2_add(y, half), is_negative(y)), bits);
  };
  return FourValues(wasm_i32x4_shuffle(down(x.low), down(x.high), 0, 2, 4, 6));
}

inline FourValues limited(FourValues x, FourValues most) {
  return FourValues(wasm_i32x4_max(wasm_i32x4_min(x.v, most.v), wasm_i32x4_neg(most.v)));
}

inline std::int32_t differ(FourValues a, FourValues b) {
  return wasm_v128_any_true(wasm_v128_xor(a.v, b.v));
}

#endif

/// Calls body(place) for values 0 .. lanes - 1, four together where a register holds them.
template <class Body>
SLF_IN_LINE void for_values(std::size_t lanes, const Body& body) {
  std::size_t j = 0;
#if defined(__wasm_simd128__)
  for (; j + 4 <= lanes; j += 4) body(FourPlaces{j});
#endif
  for (; j < lanes; ++j) body(j);
}

}  // namespace slf
