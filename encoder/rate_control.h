// SPDX-License-Identifier: Apache-2.0
// The quantiser step for which a file has a given size, or a given quality.
#pragma once

#include <functional>

#include "slf/error.h"

namespace slf {

inline constexpr double kLeastQ = 0.05, kMostQ = 4096;
inline constexpr double kLossFirst = 32;  ///< where a search for a loss begins

/// What is good enough, of a quantity that falls while Q grows, best along a line in log Q: PSNR,
/// or the logarithm of bytes.
struct StepGoal {
  double least, most;
};

struct StepFound {
  double q = 0, value = 0;  ///< a step, and what was measured there
  bool reached = false;     ///< value is within the goal; if not, it is the nearest that was met
};

/// Looks for a Q in kLeastQ .. kMostQ whose measure(Q) is within the goal: false position on
/// (log Q, value) within a bracket, halved where that does not help. The last Q found is not always
/// the last measured. At most 14 measurements; fewer than 7 where the curve is smooth.
/// @param factor  from the first guess to the other end of a bracket; above 1
/// @errors those of measure, which ends the search.
Result<StepFound, InputError> find_step(
    double first_guess, const StepGoal& goal,
    const std::function<Result<double, InputError>(double q)>& measure, double factor = 4);

/// The largest step, to three digits, whose PSNR is no more than `loss` below `unquantised` and
/// below what any smaller step has that was tried. A step may be better than none: it leaves out
/// what a fit makes up. Doubled or halved from kLossFirst, then twice between the last that is good
/// enough and the first that is not: five to eight measurements, as a rule. kLeastQ where none is.
/// @param measure  PSNR with a step, dB
/// @return `value` is what it loses against the best, at most `loss` where `reached`
/// @errors those of measure, which ends the search.
Result<StepFound, InputError> find_largest_step(
    double unquantised, double loss,
    const std::function<Result<double, InputError>(double q)>& measure);

}  // namespace slf
