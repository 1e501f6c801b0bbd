// SPDX-License-Identifier: Apache-2.0
#include "attributes/encoder/row_quantiser.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace slf {
namespace {

/// Squared error in 4096ths of a squared step. Larger ones than 2^20 steps are alike.
std::uint64_t distortion(std::uint32_t magnitude, std::uint32_t level, const QuantiserStep& step) {
  const std::int64_t difference = std::int64_t{magnitude} - std::int64_t{level} * step.step();
  const std::uint64_t error =
      step.divide(std::uint64_t{64} * static_cast<std::uint64_t>(std::abs(difference)));
  const std::uint64_t bounded = std::min<std::uint64_t>(error, 1u << 26);
  return bounded * bounded;
}

}  // namespace

RowQuantiser::RowQuantiser(std::vector<std::size_t> planes, std::span<const std::uint32_t> steps,
                           double strength, std::size_t rows)
    : planes_(std::move(planes)),
      lambda_q12_(static_cast<std::uint64_t>(std::lround(strength * 0.15 * 4096))),
      model_(planes_.size()),
      counts_(rows, 0),
      chosen_(planes_.size()) {
  for (const std::size_t j : planes_) step_.emplace_back(steps[j]);
}

void RowQuantiser::adopt(const std::int32_t* coefficients, std::uint32_t row) {
  const auto count = std::count_if(planes_.begin(), planes_.end(),
                                   [&](std::size_t j) { return coefficients[j] != 0; });
  counts_[row] = static_cast<std::uint8_t>(std::min<std::ptrdiff_t>(count, 255));
}

/// Values of a block that is coded; returns its cost, and that of leaving it out.
std::uint64_t RowQuantiser::choose_block(const std::int32_t* coefficients,
                                         const std::int32_t* parent, std::size_t begin,
                                         std::size_t end, std::uint64_t& all_zero) {
  std::uint64_t coded = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const std::int32_t value = coefficients[planes_[i]];
    const std::int32_t above = parent != nullptr ? parent[planes_[i]] : 0;
    const auto magnitude = static_cast<std::uint32_t>(std::abs(std::int64_t{value}));
    const auto nearest = static_cast<std::uint32_t>(std::abs(step_[i].quantise(value)));
    const AdaptiveCost& nonzero = model_.value(i, above);
    const std::uint64_t zero = distortion(magnitude, 0, step_[i]);
    all_zero += zero;
    std::uint64_t best = zero + cost(nonzero.of(false));
    std::uint32_t level = 0;
    for (std::uint32_t q = nearest; q > 0 && q + 1 >= nearest; --q) {
      const std::uint64_t j = distortion(magnitude, q, step_[i]) +
                              cost(nonzero.of(true) + model_.magnitude_cost(q, above));
      if (j < best) best = j, level = q;
    }
    coded += best;
    chosen_[i] = value < 0 ? -static_cast<std::int32_t>(level) : static_cast<std::int32_t>(level);
  }
  return coded;
}

void RowQuantiser::adapt(const std::int32_t* parent, bool coded, std::uint32_t parent_count,
                         std::uint32_t before) {
  model_.node(parent_count, before).update(coded);
  if (!coded) return;
  bool begun = false;
  for (std::size_t begin = 0; begin < planes_.size(); begin += RateModel::kBlock) {
    const std::size_t end = std::min(begin + RateModel::kBlock, planes_.size());
    bool any = false, parent_any = false;
    for (std::size_t i = begin; i < end; ++i) {
      any |= chosen_[i] != 0;
      parent_any |= parent != nullptr && parent[planes_[i]] != 0;
    }
    model_.block(begin / RateModel::kBlock, parent_any, begun).update(any);
    if (!any) continue;
    begun = true;
    for (std::size_t i = begin; i < end; ++i) {
      const std::int32_t above = parent != nullptr ? parent[planes_[i]] : 0;
      model_.value(i, above).update(chosen_[i] != 0);
      if (chosen_[i] != 0)
        model_.update_magnitude(static_cast<std::uint32_t>(std::abs(chosen_[i])), above);
    }
  }
}

void RowQuantiser::quantise_row(std::int32_t* coefficients, std::uint32_t row,
                                const std::int32_t* parent, std::uint32_t parent_row) {
  if (lambda_q12_ == 0) {
    for (std::size_t i = 0; i < planes_.size(); ++i) {
      std::int32_t& value = coefficients[planes_[i]];
      value = step_[i].quantise(value);
    }
    return;
  }
  const std::uint32_t parent_count = parent != nullptr ? counts_[parent_row] : 0u;
  std::uint64_t coded = cost(model_.node(parent_count, before_).of(true)), zero = 0;
  bool begun = false;
  for (std::size_t begin = 0; begin < planes_.size(); begin += RateModel::kBlock) {
    const std::size_t end = std::min(begin + RateModel::kBlock, planes_.size());
    bool parent_any = false;
    for (std::size_t i = begin; i < end; ++i)
      parent_any |= parent != nullptr && parent[planes_[i]] != 0;
    const AdaptiveCost& flag = model_.block(begin / RateModel::kBlock, parent_any, begun);
    std::uint64_t left_out = 0;
    const std::uint64_t with =
        choose_block(coefficients, parent, begin, end, left_out) + cost(flag.of(true));
    zero += left_out;
    left_out += cost(flag.of(false));
    if (left_out <= with) {
      std::fill(chosen_.begin() + static_cast<std::ptrdiff_t>(begin),
                chosen_.begin() + static_cast<std::ptrdiff_t>(end), 0);
      coded += left_out;
    } else {
      coded += with;
      begun = true;
    }
  }
  zero += cost(model_.node(parent_count, before_).of(false));
  if (zero <= coded) std::fill(chosen_.begin(), chosen_.end(), 0);
  std::uint32_t count = 0;
  for (const std::int32_t q : chosen_) count += q != 0;
  adapt(parent, count > 0, parent_count, before_);
  counts_[row] = static_cast<std::uint8_t>(std::min(count, 255u));
  before_ = counts_[row];
  for (std::size_t i = 0; i < planes_.size(); ++i) coefficients[planes_[i]] = chosen_[i];
}

}  // namespace slf
