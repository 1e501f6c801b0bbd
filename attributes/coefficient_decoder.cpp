// SPDX-License-Identifier: Apache-2.0
#include "attributes/coefficient_decoder.h"

#include "base/multiversion.h"
#include "entropy/range_decoder.h"

namespace slf {

SLF_MULTIVERSION_ALL
Result<Done> decode_coefficients(std::span<const std::uint8_t> payload, CoefficientModels& models,
                                 const CoefficientRows& rows, std::size_t group, std::size_t begin,
                                 std::size_t end, bool cut, std::size_t layer) {
  constexpr const char* kMagnitude = "cu_magnitude";
  if (payload.empty()) {  // all are zero, or all bits
    if (layer > 0 && !models.double_values(rows, group, begin, end))
      return Error{Errc::kOutOfRange, kMagnitude};
    return Done{};
  }
  RangeDecoder decoder(payload);
  if (!models.code(decoder, rows, group, begin, end, layer))
    return decoder.exhausted() ? decoder.finish("cu_coefficients")
                               : decoder.here(Errc::kOutOfRange, kMagnitude);
  if (cut) return Done{};
  return decoder.finish("cu_coefficients");
}

}  // namespace slf
