// SPDX-License-Identifier: Apache-2.0
// Photographs whose exposure and white balance drift, as a camera's automatic ones do.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "slf/capture.h"

namespace slf::synth {

/// Factors of R, G, B of one photograph: 1 - drift .. 1 + drift for all, times 1 - drift / 2 ..
/// 1 + drift / 2 for each. The same for the same seed and photograph.
std::array<double, 3> drawn_gains(std::uint64_t seed, std::size_t photograph, double drift);

/// Display values times the factors, rounded and clipped.
void expose(Image& image, const std::array<double, 3>& gains);

}  // namespace slf::synth
