// SPDX-License-Identifier: Apache-2.0
// The sRGB transfer curve (IEC 61966-2-1), on 0 .. 1.
#pragma once

namespace slf {

/// Display value to linear light.
double srgb_to_linear(double display);
/// Linear light to display value.
double linear_to_srgb(double linear);

}  // namespace slf
