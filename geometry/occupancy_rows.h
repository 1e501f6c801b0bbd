// SPDX-License-Identifier: Apache-2.0
// What speaks for the children of a node, added up. Spec 8.4.7.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "entropy/eight_lanes.h"
#include "entropy/logistic.h"

namespace slf {

/// The rows a node selects: logistic values of eight decisions in 1/4096, of its children or of the
/// places of an only child. They are added, and all move by how wrong their sum was.
class SelectedRows {
 public:
  /// As many as a node may select. Apart from the rest, which is for registers.
  using List = std::array<EightLanes*, 1 + 56 + 26 + 3 + 10 + 64 + 1>;  // OccupancyModel::rows_of

  /// list: kept by reference.
  SelectedRows(EightLanes* rows, List& list) : rows_(rows), selected_(list) {}

  void add(std::size_t row) {
    selected_[count_++] = rows_ + row;
    sum_ = sum_.saturating_plus(rows_[row]);
  }
  /// The rows so far move slower than those to come.
  void end_slow() { slow_ = count_; }

  /// What the sum says of the decisions, in 1/256.
  std::array<std::int16_t, 8> logistic() const {
    std::array<std::int16_t, 8> values = sum_.values();
    for (auto& value : values) value = static_cast<std::int16_t>(value >> 4);
    return values;
  }

  /// decided, ones: those that were made, and those that were 1. rate: 1 .. 8.
  void update(unsigned decided, unsigned ones, std::int32_t rate) const {
    std::array<std::int16_t, 8> errors = logistic();
    for (unsigned i = 0; i < 8; ++i) {
      const auto target = static_cast<std::int32_t>((ones >> i & 1) << 16);
      const std::int32_t error = (target - squash(errors[i])) >> 1;
      errors[i] = static_cast<std::int16_t>((decided >> i & 1) != 0 ? error : 0);
    }
    move(0, slow_, EightLanes(errors).times(kSlow * rate));
    move(slow_, count_, EightLanes(errors).times(kFast * rate));
  }

 private:
  // Found on the clouds of docs/decisions/002.
  static constexpr std::int32_t kSlow = 32, kFast = 128;

  void move(std::size_t begin, std::size_t end, EightLanes step) const {
    for (std::size_t i = begin; i < end; ++i) {
      EightLanes& row = *selected_[i];
      row = row.saturating_plus(step);
    }
  }

  EightLanes* rows_;
  EightLanes sum_;
  std::size_t count_ = 0, slow_ = 0;
  List& selected_;
};

}  // namespace slf
