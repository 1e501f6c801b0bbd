// SPDX-License-Identifier: Apache-2.0
// The paper's way: every plane alone, with one adaptive context set of its own for all levels.
// Written once for decoder and encoder. Spec 8.7.3.
#pragma once

#include <cstdint>
#include <vector>

#include "attributes/coefficient_layout.h"
#include "attributes/states_in_use.h"
#include "entropy/adaptive_bit.h"
#include "entropy/binarisation.h"

namespace slf {

/// What the decisions of a group leave to those of its next unit.
struct IndependentStates {
  /// functions: of the group.
  explicit IndependentStates(std::size_t functions) : planes(3 * functions) {}

  struct Plane {
    AdaptiveBit nonzero;
    MagnitudeContexts magnitude;
  };
  std::vector<Plane> planes;
};

class IndependentCoefficients {
 public:
  explicit IndependentCoefficients(std::vector<std::uint16_t> functions)
      : functions_(std::move(functions)) {}

  /// Codes rows order[begin .. end). Returns false where the decoder met a value no encoder writes.
  template <class Coder>
  bool code(Coder& coder, const CoefficientRows& rows, std::size_t begin, std::size_t end) {
    states_.begin(functions_.size());
    for (std::size_t i = begin; i < end; ++i) {
      if constexpr (Coder::kDecodes)
        if (coder.exhausted()) return false;
      std::int32_t* row = rows.row(rows.tree.order[i]);
      std::int32_t any = 0;
      for (std::size_t f = 0; f < functions_.size(); ++f)
        for (std::size_t c = 0; c < 3; ++c) {
          std::int32_t& value = row[3u * functions_[f] + c];
          if (!code_value(coder, states_->planes[3 * f + c], value)) return false;
          any |= value;
        }
      if (any != 0) rows.set_nonzero(rows.tree.order[i]);
    }
    return true;
  }

  const std::vector<std::uint16_t>& functions() const { return functions_; }
  StatesInUse<IndependentStates>& states() { return states_; }

 private:
  static constexpr std::uint32_t kLimit = 30;  // coarse to fine: forget quickly

  using Plane = IndependentStates::Plane;

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
  StatesInUse<IndependentStates> states_;
};

}  // namespace slf
