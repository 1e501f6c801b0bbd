// The floor of a square root.
#pragma once

#include <cstdint>

namespace slf {

/// floor(sqrt(n)), exactly.
std::uint64_t isqrt(std::uint64_t n);

}  // namespace slf
