// SPDX-License-Identifier: Apache-2.0
// The floor of a square root.
#pragma once

#include <cstdint>

namespace slf {

/// floor(sqrt(n)), exactly. 32 steps.
std::uint64_t isqrt(std::uint64_t n);

}  // namespace slf
