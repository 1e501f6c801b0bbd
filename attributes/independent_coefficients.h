// The paper's way: every plane alone, with one adaptive context set of its own for all levels.
// Written once for decoder and encoder. Spec 8.7.3.
#pragma once

#include <cstdint>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"

namespace slf {

class IndependentCoefficients {
 public:
  explicit IndependentCoefficients(std::vector<std::uint16_t> functions)
      : functions_(std::move(functions)), planes_(3 * functions_.size()) {}

  /// Codes rows order[begin .. end). Returns false where the decoder met a value no encoder writes.
  template <class Coder>
  bool code(Coder& coder, const CoefficientRows& rows, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      if constexpr (Coder::kDecodes)
        if (coder.exhausted()) return false;
      std::int32_t* row = rows.row(rows.tree.order[i]);
      std::int32_t any = 0;
      for (std::size_t f = 0; f < functions_.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c) {
          std::int32_t& value = row[3u * functions_[f] + c];
          if (!code_value(coder, planes_[3 * f + c], value)) return false;
          any |= value;
        }
      if (any != 0) rows.set_nonzero(rows.tree.order[i]);
    }
    return true;
  }

  const std::vector<std::uint16_t>& functions() const { return functions_; }

 private:
  static constexpr std::uint32_t kLimit = 30;  // coarse to fine: forget quickly

  struct Plane {
    AdaptiveBit nonzero;
    MagnitudeContexts magnitude;
  };

  template <class Coder>
  static bool code_value(Coder& coder, Plane& plane, std::int32_t& value) {
    if (!coder.bit(plane.nonzero, kLimit, !Coder::kDecodes && value != 0)) return true;
    const std::uint32_t magnitude = code_magnitude(
        coder, plane.magnitude, kLimit, static_cast<std::uint32_t>(value < 0 ? -value : value));
    const bool negative = coder.raw(1, value < 0);
    if (magnitude == 0) return false;
    if (Coder::kDecodes)
      value =
          negative ? -static_cast<std::int32_t>(magnitude) : static_cast<std::int32_t>(magnitude);
    return true;
  }

  std::vector<std::uint16_t> functions_;
  std::vector<Plane> planes_;
};

}  // namespace slf
