// SPDX-License-Identifier: Apache-2.0
// Octahedral normals, each predicted by the one before it in Morton order. Written once for decoder
// and encoder. Spec 8.10.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"

namespace slf {

class NormalModel {
 public:
  explicit NormalModel(int bits) : bits_(bits) {}

  /// Codes the next normal. Returns false where the decoder met a value no encoder writes.
  template <class Coder>
  bool code(Coder& coder, std::array<std::uint16_t, 2>& normal) {
    std::uint32_t first_size = 0;
    for (std::size_t c = 0; c < 2; ++c) {
      const std::int32_t side = 1 << bits_;
      std::int32_t residual = normal[c] - previous_[c];  // wraps to -side / 2 .. side / 2 - 1
      if (residual < -side / 2) residual += side;
      if (residual >= side / 2) residual -= side;
      Component& contexts = components_[c * 3 + (c == 0 ? 0 : first_size)];
      if (!code_residual(coder, contexts, residual)) return false;
      first_size = residual == 0 ? 0 : residual == 1 || residual == -1 ? 1 : 2;
      normal[c] = static_cast<std::uint16_t>((previous_[c] + residual + side) & (side - 1));
      previous_[c] = normal[c];
    }
    return true;
  }

 private:
  static constexpr std::uint32_t kLimit = 255;

  struct Component {
    AdaptiveBit nonzero, negative;
    MagnitudeContexts magnitude;
  };

  template <class Coder>
  bool code_residual(Coder& coder, Component& contexts, std::int32_t& residual) {
    if (!coder.bit(contexts.nonzero, kLimit, !Coder::kDecodes && residual != 0)) {
      residual = 0;
      return true;
    }
    const bool negative = coder.bit(contexts.negative, kLimit, residual < 0);
    const std::uint32_t magnitude =
        code_magnitude(coder, contexts.magnitude, kLimit,
                       static_cast<std::uint32_t>(residual < 0 ? -residual : residual));
    const std::uint32_t most = (1u << (bits_ - 1)) - (negative ? 0 : 1);
    if (magnitude == 0 || magnitude > most) return false;
    residual =
        negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
    return true;
  }

  int bits_;
  std::array<std::int32_t, 2> previous_{0, 0};
  std::array<Component, 6>
      components_;  // the second component knows the size of the first's residual
};

}  // namespace slf
