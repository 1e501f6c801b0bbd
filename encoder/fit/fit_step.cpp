// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/fit_step.h"

#include <type_traits>

#include "encoder/fit/fit_least_norm.h"

namespace slf {
namespace {

/// Below this a factor in float loses more than 1/1000 grey level (see fit_test); double is used.
constexpr double kSmallestFloatPenalty = 0.5;

/// Factors beyond this are computed again in every sweep.
constexpr std::size_t kMaxKeptBytes = std::size_t{1} << 30;

}  // namespace

RidgeStep::RidgeStep(const Observations& observations, const FitSettings& settings, double penalty,
                     int solves)
    : observations_(observations),
      basis_(settings.basis),
      penalise_dc_(settings.penalise_dc),
      penalty_(penalty) {
  if (solves < 2 || penalty < kSmallestFloatPenalty) return;
  const std::size_t points = observations.first.size() - 1;
  const RidgeSolver<float> solver(basis_, penalise_dc_);
  std::vector<std::size_t> first{0};
  for (std::size_t p = 0; p < points; ++p) {
    const std::size_t m = seen(p).directions.size();
    first.push_back(first.back() + (m == 0 ? 0 : solver.factor_size(m)));
    if (first.back() > kMaxKeptBytes / sizeof(float)) return;
  }
  first_ = std::move(first);
  kept_ = std::make_unique_for_overwrite<float[]>(first_.back());
  has_factor_.assign(points, 0);
}

PointObservations RidgeStep::seen(std::size_t point) const {
  const auto begin = static_cast<std::size_t>(observations_.first[point]);
  const auto size = static_cast<std::size_t>(observations_.first[point + 1]) - begin;
  return {std::span(observations_.direction).subspan(begin, size),
          std::span(observations_.colour).subspan(begin, size)};
}

void RidgeStep::solve(std::size_t begin, std::size_t end, float* coefficients) {
  if (penalty_ == 0) return solve_least_norm(begin, end, coefficients);
  if (penalty_ < kSmallestFloatPenalty) return solve_ridge<double>(begin, end, coefficients);
  solve_ridge<float>(begin, end, coefficients);
}

template <class Real>
void RidgeStep::solve_ridge(std::size_t begin, std::size_t end, float* coefficients) {
  RidgeSolver<Real> solver(basis_, penalise_dc_);
  const std::size_t size = 3 * static_cast<std::size_t>(basis_.num_functions());
  std::vector<Real> own_factor;
  for (std::size_t p = begin; p < end; ++p) {
    const PointObservations observed = seen(p);
    if (observed.directions.empty()) continue;
    Real* factor = nullptr;
    bool known = false;
    if constexpr (std::is_same_v<Real, float>)
      if (kept_) {
        factor = kept_.get() + first_[p];
        known = has_factor_[p] != 0;
        has_factor_[p] = 1;
      }
    if (factor == nullptr) {
      own_factor.resize(solver.factor_size(observed.directions.size()));
      factor = own_factor.data();
    }
    if (!known) solver.factorise(observed.directions, penalty_, factor);
    solver.solve(observed, factor, coefficients + p * size);
  }
}

void RidgeStep::solve_least_norm(std::size_t begin, std::size_t end, float* coefficients) const {
  const std::size_t size = 3 * static_cast<std::size_t>(basis_.num_functions());
  for (std::size_t p = begin; p < end; ++p)
    if (const PointObservations observed = seen(p); !observed.directions.empty())
      fit_least_norm(basis_, penalise_dc_, observed, coefficients + p * size);
}

}  // namespace slf
