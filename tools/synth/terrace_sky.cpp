// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_sky.h"

#include "tools/synth/noise.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr std::uint32_t kClouds = 77;
constexpr Colour kZenith{0.12, 0.27, 0.60}, kHorizon{0.70, 0.79, 0.90}, kGround{0.20, 0.18, 0.15};

}  // namespace

Vec3 to_sun() {
  static const Vec3 direction = normalised({-0.72, -0.50, 0.62});
  return direction;
}

Colour plain_sky(const Vec3& direction) {
  const double up = direction[2];
  if (up < -0.04) return kGround;
  const Colour blue = mix(kHorizon, kZenith, std::pow(std::max(up, 0.0), 0.55));
  const double glow = power(std::max(0.0, dot(direction, to_sun())), 6);
  return mix(0.7 * kHorizon, blue + 0.16 * glow * kSunlight, smoothstep(-0.04, 0.01, up));
}

Colour sky(const Vec3& direction) {
  Colour light = plain_sky(direction);
  const double up = direction[2];
  const double towards = std::max(0.0, dot(direction, to_sun()));
  if (up > 0.02) {
    // A layer of clouds at a height of 1, seen in perspective and lost in the haze.
    const double x = direction[0] / (up + 0.08), y = direction[1] / (up + 0.08);
    const double cover = smoothstep(0.46, 0.78, cloudy_noise(1.1 * x + 5, 1.5 * y, kClouds));
    const Colour lit{0.93, 0.92, 0.91}, shade{0.62, 0.67, 0.74};
    const double thick = cloudy_noise(2.2 * x + 1, 3 * y + 9, kClouds + 9);
    light = mix(light, mix(lit, shade, thick), 0.85 * cover * smoothstep(0.02, 0.22, up));
  }
  if (up > -0.04)
    light = light + (12 * power(towards, 4000) + 0.5 * power(towards, 180)) * kSunlight;
  return light;
}

Colour country(const Vec3& eye, const Vec3& direction) {
  const double away = -eye[2] / direction[2];
  const double x = eye[0] + away * direction[0], y = eye[1] + away * direction[1];
  // Strips of land, askew to the streets, bent a little.
  const double u = 0.8 * x + 0.6 * y + 25 * value_noise(x / 90, y / 90, 5), v = 0.8 * y - 0.6 * x;
  const double field = unit(cell_bits(std::floor(u / 60), std::floor(v / 110), 9));
  const double rows = value_noise(u / 1.5, v / 14, 12) * (1 - smoothstep(80, 300, away));
  const double wood = smoothstep(0.6, 0.63, cloudy_noise(x / 120 + 3.7, y / 120 + 1.2, 31));
  const Colour crop = mix(Colour{0.20, 0.25, 0.07}, Colour{0.42, 0.36, 0.16}, field);
  const Colour leaves = (0.6 + 0.8 * cloudy_noise(x / 4, y / 4, 33)) * Colour{0.08, 0.14, 0.05};
  const Colour land = mix((0.8 + 0.3 * rows) * crop, leaves, wood);
  return mix(land, plain_sky(normalised({direction[0], direction[1], 0.03})),
             1 - std::exp(-away / 900));
}

Colour skylight(const Vec3& normal) {
  return mix(Colour{0.20, 0.18, 0.15}, Colour{0.42, 0.50, 0.62}, 0.5 + 0.5 * normal[2]);
}

}  // namespace slf::synth
