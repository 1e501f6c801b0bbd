// Magnitudes as binary decisions. Written once for decoder and encoder. Spec 8.3.4.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "entropy/adaptive_bit.h"

namespace slf {

/// Contexts of values >= 1: is it more than 1, than 2, ... than kUnary, then Exp-Golomb of the
/// rest.
struct MagnitudeContexts {
  static constexpr std::size_t kUnary = 14;
  static constexpr std::size_t kPrefix = 28;  ///< longest Exp-Golomb prefix: values below 2^28
  std::array<AdaptiveBit, kUnary> more;
  std::array<AdaptiveBit, kPrefix> prefix;
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
  // value >= reached: Exp-Golomb of order 0 of the difference, prefix in adaptive contexts.
  const std::uint32_t rest = Coder::kDecodes ? 0 : value - reached + 1;  // >= 1
  const int length = Coder::kDecodes ? 0 : static_cast<int>(std::bit_width(rest)) - 1;
  int decoded_length = 0;
  for (AdaptiveBit& longer : contexts.prefix) {
    if (!coder.bit(longer, limit, length > decoded_length))
      return reached - 1 +
             (1u << decoded_length | coder.raw(decoded_length, rest - (1u << decoded_length)));
    ++decoded_length;
  }
  return 0;
}

}  // namespace slf
