// SPDX-License-Identifier: Apache-2.0
// The quantised coefficients of a row, chosen by distortion and rate. Informative.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "attributes/encoder/rate_model.h"
#include "attributes/quantiser_step.h"

namespace slf {

/// One plane group of a slice; rows come in the order the tree is undone.
class RowQuantiser {
 public:
  /// @param planes    of the group, ascending
  /// @param steps     of all planes
  /// @param strength  0 .. 1: lambda in units of 0.15 squared steps a bit; 0: plain rounding
  RowQuantiser(std::vector<std::size_t> planes, std::span<const std::uint32_t> steps,
               double strength, std::size_t rows);

  /// @param coefficients  [all planes]; those of the group are replaced by quantised values
  /// @param parent        quantised row of the merge above; nullptr: none
  void quantise_row(std::int32_t* coefficients, std::uint32_t row, const std::int32_t* parent,
                    std::uint32_t parent_row);

  /// What was learnt of the bits, for others to start from.
  const RateModel& rates() const { return model_; }
  void start_from(const RateModel& rates) { model_ = rates; }
  /// A row that is quantised elsewhere. coefficients: [all planes]
  void adopt(const std::int32_t* coefficients, std::uint32_t row);

 private:
  std::uint64_t choose_block(const std::int32_t* coefficients, const std::int32_t* parent,
                             std::size_t begin, std::size_t end, std::uint64_t& all_zero);
  void adapt(const std::int32_t* parent, bool coded, std::uint32_t parent_count,
             std::uint32_t before);
  std::uint64_t cost(std::uint32_t bits_q8) const { return (bits_q8 * lambda_q12_) >> 8; }

  std::vector<std::size_t> planes_;
  std::vector<QuantiserStep> step_;
  std::uint64_t lambda_q12_;
  RateModel model_;
  std::vector<std::uint8_t> counts_;  // [rows] non-zero values
  std::vector<std::int32_t> chosen_;  // [group planes]
  std::uint32_t before_ = 0;          // count of the row before
};

}  // namespace slf
