// SPDX-License-Identifier: Apache-2.0
// What a fit refuses.
#pragma once

#include <cstddef>

#include "slf/error.h"
#include "slf/fit.h"

namespace slf {

/// @errors kInvalidArgument: names the setting and its range.
Result<Done, InputError> check_fit_settings(const FitSettings& settings);

/// @errors kInvalidArgument: not shaped as those of so many points. kInvalidInput: there are none.
Result<Done, InputError> check_observations(const Observations& seen, std::size_t points);

}  // namespace slf
