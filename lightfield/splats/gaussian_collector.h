// SPDX-License-Identifier: Apache-2.0
// Splats of a file, checked one by one.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>

#include "slf/gaussian_files.h"

namespace slf {

inline constexpr float kHarmonicZero = 0.28209479177387814f;  // 1 / sqrt(4 pi)

/// exp(-40) is nothing beside any scene, and squares of exp(40) fit into a float.
inline constexpr float kMostLogDeviation = 40;

/// A splat as a file has it, anything at all.
struct RawGaussian {
  std::array<float, 3> position{};
  std::array<float, 3> log_deviations{};
  std::array<float, 4> rotation{};  ///< w, x, y, z; of any length
  float logit = 0;
};

class GaussianCollector {
 public:
  /// @param count  splats for which there is room; the caller has seen their bytes
  GaussianCollector(int degree, UpAxis up, std::size_t count);

  /// @param harmonics  [(degree + 1)^2][3]
  void add(const RawGaussian& raw, std::span<const float> harmonics);

  /// @errors kInvalidInput: not one was kept
  Result<GaussianFile, InputError> take(const std::string& name, std::string format) &&;

 private:
  GaussianFile file_;
};

/// Natural logarithm of a deviation; -inf of 0, NaN of what is less.
inline float log_deviation_of(float deviation) { return std::log(deviation); }

/// Logit of an opacity of 0 .. 1; those ends, and what is beyond, become infinite.
inline float logit_of(float opacity) {
  if (opacity >= 1) return INFINITY;
  return opacity <= 0 ? -INFINITY : std::log(opacity / (1 - opacity));
}

/// Logit of an opacity in 255ths. The ends stand for what rounds to them.
inline float logit_of_byte(std::uint8_t byte) {
  return logit_of(std::clamp(static_cast<float>(byte), 0.25f, 254.75f) / 255);
}

/// Coefficient of degree 0 of a colour, 0 .. 1.
inline float harmonic_of_colour(float colour) { return (colour - 0.5f) / kHarmonicZero; }

/// The degree of so many harmonics beyond degree 0, of one channel each; -1: of none.
inline int degree_of_rest(std::size_t functions) {
  for (int degree = 0; degree <= 4; ++degree)
    if (functions + 1 == std::size_t(degree + 1) * std::size_t(degree + 1)) return degree;
  return -1;
}

}  // namespace slf
