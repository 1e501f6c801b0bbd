// SPDX-License-Identifier: Apache-2.0
// Magnitudes as binary decisions. Written once for decoder and encoder. Spec 8.3.4.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "entropy/adaptive_bit.h"

namespace slf {

/// Contexts of Exp-Golomb prefixes: values below 2^28.
using PrefixContexts = std::array<AdaptiveBit, 28>;

/// Codes value >= 1 (decoder: the argument is ignored) as Exp-Golomb of order 0, the prefix in
/// adaptive contexts. Returns 0 where a damaged stream has a longer prefix than a value can have.
template <class Coder>
std::uint32_t code_exp_golomb(Coder& coder, PrefixContexts& prefix, std::uint32_t limit,
                              std::uint32_t value) {
  const int length = Coder::kDecodes ? 0 : static_cast<int>(std::bit_width(value)) - 1;
  int decoded_length = 0;
  for (AdaptiveBit& longer : prefix) {
    if (!coder.bit(longer, limit, length > decoded_length))
      return 1u << decoded_length | coder.raw(decoded_length, value - (1u << decoded_length));
    ++decoded_length;
  }
  return 0;
}

/// Contexts of values >= 1: is it more than 1, than 2, ... than kUnary, then Exp-Golomb of the
/// rest.
struct MagnitudeContexts {
  static constexpr std::size_t kUnary = 14;
  std::array<AdaptiveBit, kUnary> more;
  PrefixContexts prefix;
};

/// Codes value >= 1 (decoder: the argument is ignored). Returns 0 where a damaged stream has a
/// longer prefix than a value can have.
template <class Coder>
std::uint32_t code_magnitude(Coder& coder, MagnitudeContexts& contexts, std::uint32_t limit,
                             std::uint32_t value) {
  std::uint32_t reached = 1;
  for (AdaptiveBit& more : contexts.more) {
    if (!coder.bit(more, limit, value > reached)) return reached;
    ++reached;
  }
  const std::uint32_t rest =
      code_exp_golomb(coder, contexts.prefix, limit, Coder::kDecodes ? 0 : value - reached + 1);
  return rest == 0 ? 0 : reached - 1 + rest;
}

}  // namespace slf
