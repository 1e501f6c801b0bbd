// SPDX-License-Identifier: Apache-2.0
// One context more of two decisions about a vector, by what the reference has in its place. Spec
// 8.12.6.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "attributes/node_prediction.h"
#include "attributes/reference_coefficients.h"
#include "entropy/context_bit.h"
#include "entropy/context_shape.h"
#include "entropy/log_class.h"

namespace slf {

/// Contexts that predicted frames add to the states of a group.
struct ReferenceStates {
  using Node = ContextShape<26, 3, 12>;              // sum; prediction; magnitude expected
  using Magnitude = ContextShape<13, 3, 12, 3, 16>;  // its own; as above; channel; unary code
  /// What their weights begin with, of 8192: a fourth of 8500, as that of one of four contexts.
  static constexpr std::int16_t kFirstWeight = 2125;
  /// Bytes of memory.
  static constexpr std::size_t kBytes = sizeof(ContextBit) * (Node::kCount + Magnitude::kCount);

  std::vector<ContextBit> node = std::vector<ContextBit>(Node::kCount),
                          more = std::vector<ContextBit>(Magnitude::kCount);
};

/// A row, as the reference has it.
class ReferenceRow {
 public:
  ReferenceRow() = default;  ///< nothing is known
  /// quarters: of all planes of the row. prediction: that of its level
  ReferenceRow(const std::uint8_t* quarters, std::uint32_t prediction)
      : quarters_(quarters), prediction_(prediction) {}

  bool is_known() const { return quarters_ != nullptr; }

  /// functions: the group's. size: class of the expected magnitude, 0 .. 47
  std::uint32_t node(const std::vector<std::uint16_t>& functions, std::uint32_t size) const {
    using Node = ReferenceStates::Node;
    std::uint32_t sum = 0;
    for (const std::size_t f : functions)
      sum += std::uint32_t{quarters_[3 * f]} + quarters_[3 * f + 1] + quarters_[3 * f + 2];
    const bool none = quarters_[0] == ReferenceCoefficients::kNone;  // of all planes, or of none
    return Node::index(none ? Node::kMost<0> : log_class(sum, Node::kMost<0> - 1), prediction_,
                       size / 4);
  }

  /// The first of the contexts of a magnitude. plane: of all
  std::uint32_t magnitude(std::size_t plane, std::uint32_t size) const {
    using Magnitude = ReferenceStates::Magnitude;
    const std::uint8_t own = quarters_[plane];
    return Magnitude::index(
        own == ReferenceCoefficients::kNone ? Magnitude::kMost<0> : log_class(own, 23) / 2,
        prediction_, size / 4, plane % 3, 0);
  }

 private:
  const std::uint8_t* quarters_ = nullptr;
  std::uint32_t prediction_ = 0;
};

/// What the vectors of a group know of the reference.
struct GroupReference {
  bool is_known() const { return coefficients != nullptr; }
  ReferenceRow row(std::size_t row, std::uint32_t split) const {
    if (!is_known()) return {};
    return {coefficients->row(row), row == 0 ? 0u : prediction[split / 3]};
  }

  const ReferenceCoefficients* coefficients = nullptr;  ///< nullptr: nothing
  /// By a third of the split: is the level predicted from the reference? 0: not, 1: from it alone,
  /// 2: in part.
  std::array<std::uint8_t, 22> prediction{};
};

/// modes: cu_prediction of levels `level`, level + 1, ..
inline GroupReference group_reference(const ReferenceCoefficients& coefficients,
                                      std::span<const std::uint32_t> modes, std::uint32_t level,
                                      std::uint32_t grid_bits) {
  GroupReference group{&coefficients, {}};
  for (const std::uint32_t mode : modes)
    group.prediction[grid_bits - 1 - level++] =
        static_cast<std::uint8_t>(mode < kFromReference    ? 0
                                  : mode == kFromReference ? 1
                                                           : 2);
  return group;
}

}  // namespace slf
