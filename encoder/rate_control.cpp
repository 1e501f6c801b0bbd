// SPDX-License-Identifier: Apache-2.0
#include "encoder/rate_control.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace slf {
namespace {

constexpr int kMostTrials = 14;
constexpr double kSameStep = 1.001;  // steps nearer than that are one
constexpr int kRefinements = 2;
constexpr double kNearEnough = 0.85;  // of a loss

struct Trial {
  double log_q, value;
};

double distance(double value, const StepGoal& goal) {
  return std::max({goal.least - value, value - goal.most, 0.0});
}

/// To so many significant digits: four are how a step is written down.
double rounded(double q, int digits = 4) {
  const double unit = std::pow(10.0, std::floor(std::log10(q)) - digits + 1);
  return std::clamp(std::round(q / unit) * unit, kLeastQ, kMostQ);
}

/// Between a trial above the goal and one below it: where the line through both meets its middle,
/// kept off the ends so that the bracket shrinks.
double between(const Trial& above, const Trial& below, const StepGoal& goal, bool halve) {
  const double middle = (goal.least + goal.most) / 2;
  const double share = (above.value - middle) / (above.value - below.value);
  const bool infinite = !std::isfinite(above.value - below.value);  // PSNR of what is exact
  return above.log_q +
         (halve || infinite ? 0.5 : std::clamp(share, 0.05, 0.95)) * (below.log_q - above.log_q);
}

}  // namespace

Result<StepFound, InputError> find_step(
    double first_guess, const StepGoal& goal,
    const std::function<Result<double, InputError>(double q)>& measure, double factor) {
  const double least = std::log(kLeastQ), most = std::log(kMostQ);
  StepFound found;
  std::optional<Trial> above, below;  // the goal; above has the smaller step
  double log_q = std::clamp(std::log(first_guess), least, most);
  double width = most - least;
  for (int trial = 0; trial < kMostTrials; ++trial) {
    const double q = rounded(std::exp(log_q));
    SLF_TRY(const double value, measure(q));
    if (trial == 0 || distance(value, goal) < distance(found.value, goal))
      found = {q, value, distance(value, goal) == 0};
    if (found.reached) break;
    (value > goal.most ? above : below) = Trial{log_q, value};
    if (above && below) {
      const double now = std::abs(below->log_q - above->log_q);
      if (now < std::log(kSameStep)) break;
      log_q = between(*above, *below, goal, now > width / 2);
      width = now;
    } else if (above) {
      if (above->log_q >= most) break;
      log_q = std::min(above->log_q + std::log(factor), most);
    } else {
      if (below->log_q <= least) break;
      log_q = std::max(below->log_q - std::log(factor), least);
    }
  }
  return found;
}

Result<StepFound, InputError> find_largest_step(
    double unquantised, double loss,
    const std::function<Result<double, InputError>(double q)>& measure) {
  double best = unquantised;
  std::optional<Trial> good, bad;
  const auto lost = [&](const Trial& trial) { return best - trial.value; };
  const auto try_step = [&](double q) -> Result<Done, InputError> {
    const double step = rounded(q, 3);
    SLF_TRY(const double value, measure(step));
    best = std::max(best, value);
    const Trial trial{std::log(step), value};
    (lost(trial) <= loss ? good : bad) = trial;
    return Done{};
  };
  SLF_CHECK(try_step(kLossFirst));
  while (!good && bad->log_q > std::log(kLeastQ)) SLF_CHECK(try_step(std::exp(bad->log_q) / 2));
  while (!bad && good->log_q < std::log(kMostQ)) SLF_CHECK(try_step(std::exp(good->log_q) * 2));
  for (int i = 0; i < kRefinements && good && bad && lost(*good) < kNearEnough * loss; ++i) {
    const StepGoal goal{best - loss, best - kNearEnough * loss};
    SLF_CHECK(try_step(std::exp(between(*good, *bad, goal, false))));
  }
  if (!good) return StepFound{kLeastQ, lost(*bad), false};
  return StepFound{rounded(std::exp(good->log_q), 3), lost(*good), true};
}

}  // namespace slf
