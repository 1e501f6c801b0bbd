// SPDX-License-Identifier: Apache-2.0
// A prediction mode on trial. Informative: an encoder may choose as it likes.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "attributes/encoder/rate_model.h"
#include "attributes/quantiser_step.h"

namespace slf {

/// What a level of a plane would be like in a mode: how often each small magnitude came, and the
/// squared error.
struct ModeTrial {
  std::array<std::uint32_t, 17> count{};
  std::uint64_t long_bits_q8 = 0, distortion_q12 = 0;

  void add(std::uint32_t error, std::uint32_t magnitude, const QuantiserStep& step) {
    ++count[std::min(magnitude, 16u)];
    if (magnitude >= 16) long_bits_q8 += 2 * log2_q8(magnitude - 15) + 256;
    const std::uint64_t e =
        std::min<std::uint64_t>(step.divide(std::uint64_t{64} * error), 1u << 20);
    distortion_q12 += e * e;
  }
  /// Bits by the plane's own statistics, and distortion at 0.15 squared steps a bit; 256ths.
  std::uint64_t cost_q8() const {
    std::uint64_t total = 0, bits = long_bits_q8;
    for (const std::uint32_t n : count) total += n;
    for (std::size_t i = 0; i < count.size(); ++i)
      if (count[i] > 0)
        bits += count[i] * std::uint64_t{log2_q8(total) - log2_q8(count[i])} +
                (i > 0 ? count[i] * 256u : 0u);
    return bits + distortion_q12 * 20 / (3 * 16);
  }
};

}  // namespace slf
