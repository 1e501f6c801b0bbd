// SPDX-License-Identifier: Apache-2.0
// Lambert and Blinn-Phong under a few lamps, and the display curve.
#pragma once

#include <cstdint>
#include <span>

#include "tools/synth/vec.h"

namespace slf::synth {

/// A lamp without distance fall-off: its colour is the light it gives at normal incidence.
struct Lamp {
  Vec3 position;
  Colour colour;
};

struct Material {
  double diffuse = 0.8;
  double specular = 0.5;
  int exponent = 50;        ///< of Blinn-Phong
  Colour ambient{0, 0, 0};  ///< light that comes from everywhere
};

/// x^n by squaring; n >= 0.
double power(double x, int n);

/// Light from `point` towards `to_eye` (unit). No shadows are cast.
Colour shade(const SurfacePoint& point, const Colour& albedo, const Vec3& to_eye,
             const Material& material, std::span<const Lamp> lamps);

/// The sRGB curve and back; 0 .. 1.
double srgb_from_linear(double linear);
double linear_from_srgb(double display);
/// 8-bit display colour 0xRRGGBB to linear light.
Colour from_hex(std::uint32_t rgb);

}  // namespace slf::synth
