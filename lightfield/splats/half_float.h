// SPDX-License-Identifier: Apache-2.0
// Floats of 16 bits, IEEE 754.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>

namespace slf {

inline float half_float(std::uint16_t bits) {
  const int exponent = bits >> 10 & 31;
  const auto fraction = static_cast<float>(bits & 1023);
  float size = 0;
  if (exponent == 31)
    size = fraction == 0 ? std::numeric_limits<float>::infinity()
                         : std::numeric_limits<float>::quiet_NaN();
  else
    size = exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  return (bits >> 15) != 0 ? -size : size;
}

}  // namespace slf
