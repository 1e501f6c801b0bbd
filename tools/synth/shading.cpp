// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/shading.h"

namespace slf::synth {

double power(double x, int n) {
  double result = 1;
  for (; n > 0; n >>= 1, x *= x)
    if (n & 1) result *= x;
  return result;
}

Colour shade(const SurfacePoint& point, const Colour& albedo, const Vec3& to_eye,
             const Material& material, std::span<const Lamp> lamps) {
  Colour diffuse = material.ambient, specular{0, 0, 0};
  for (const Lamp& lamp : lamps) {
    const Vec3 to_lamp = normalised(lamp.position - point.position);
    const double cosine = dot(point.normal, to_lamp);
    if (cosine <= 0) continue;
    diffuse = diffuse + cosine * lamp.colour;
    if (material.specular <= 0) continue;
    const double highlight = dot(point.normal, normalised(to_lamp + to_eye));
    // Times the cosine's onset, so that no highlight ends abruptly where the lamp sets.
    // x^n < e^(-n (1 - x)): beyond 12 it is less than 0.03 grey levels even on black.
    if (material.exponent * (1 - highlight) < 12)
      specular =
          specular + smoothstep(0, 0.1, cosine) * power(highlight, material.exponent) * lamp.colour;
  }
  return material.diffuse * (albedo * diffuse) + material.specular * specular;
}

double srgb_from_linear(double linear) {
  if (linear <= 0) return 0;
  if (linear >= 1) return 1;
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

double linear_from_srgb(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

Colour from_hex(std::uint32_t rgb) {
  const auto channel = [rgb](int shift) {
    return linear_from_srgb(static_cast<double>(rgb >> shift & 0xff) / 255);
  };
  return {channel(16), channel(8), channel(0)};
}

}  // namespace slf::synth
