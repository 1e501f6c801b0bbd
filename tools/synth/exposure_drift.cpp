// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/exposure_drift.h"

#include <algorithm>
#include <cmath>

namespace slf::synth {
namespace {

/// splitmix64 (Steele, Lea, Flood 2014), of a number. 0 .. 1
double drawn_share(std::uint64_t number) {
  std::uint64_t z = (number + 1) * 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

}  // namespace

std::array<double, 3> drawn_gains(std::uint64_t seed, std::size_t photograph, double drift) {
  const std::uint64_t first = (seed << 32) + 4 * std::uint64_t{photograph};
  const double exposure = 1 + drift * (2 * drawn_share(first) - 1);
  std::array<double, 3> gains{};
  for (std::size_t k = 0; k < 3; ++k)
    gains[k] = exposure * (1 + drift / 2 * (2 * drawn_share(first + k + 1) - 1));
  return gains;
}

void expose(Image& image, const std::array<double, 3>& gains) {
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t i = 0; i < image.data.size(); i += channels)
    for (std::size_t k = 0; k < 3; ++k)
      image.data[i + k] = static_cast<std::uint8_t>(
          std::lround(std::min(double(image.data[i + k]) * gains[k], 255.0)));
}

}  // namespace slf::synth
