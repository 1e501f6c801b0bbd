// SPDX-License-Identifier: Apache-2.0
// A glazed vase that mirrors a coloured room: view dependence that is neither diffuse nor a lamp.
#include <array>
#include <numbers>

#include "tools/synth/revolution.h"
#include "tools/synth/scene.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

// Foot, belly, neck, lip, and down inside to a floor.
constexpr std::array<ProfileCorner, 16> kOutline{{{0, -0.76, 0},
                                                  {0.17, -0.76, 0.01},
                                                  {0.17, -0.8, 0.004},
                                                  {0.26, -0.8, 0.03},
                                                  {0.24, -0.7, 0.05},
                                                  {0.56, -0.12, 0.42},
                                                  {0.3, 0.36, 0.18},
                                                  {0.11, 0.5, 0.16},
                                                  {0.16, 0.7, 0.12},
                                                  {0.28, 0.78, 0.008},
                                                  {0.29, 0.8, 0.006},
                                                  {0.25, 0.782, 0.02},
                                                  {0.12, 0.7, 0.05},
                                                  {0.06, 0.5, 0.03},
                                                  {0.06, 0.3, 0.02},
                                                  {0, 0.3, 0}}};

constexpr std::array<Lamp, 3> kVaseLamps{{{{5, -3, 5}, {0.6, 0.58, 0.54}},
                                          {{-5, -2, 2}, {0.3, 0.32, 0.38}},
                                          {{0, 6, 3}, {0.4, 0.4, 0.4}}}};
constexpr Material kGlaze{0.8, 0.6, 90, {0.2, 0.2, 0.22}};

/// A soft-edged window of the room: directions within `half_angle` of `towards`.
double window(const Vec3& direction, const Vec3& towards, double cos_inner, double cos_outer) {
  return smoothstep(cos_outer, cos_inner, dot(direction, towards));
}

/// Light of the room from a direction.
Colour room(const Vec3& d) {
  Colour light =
      mix(Colour{0.10, 0.08, 0.07}, Colour{0.25, 0.36, 0.55}, smoothstep(-0.3, 0.9, d[2]));
  light = light + window(d, {0.6, -0.64, 0.48}, 0.93, 0.90) * Colour{2.6, 2.4, 2.0};
  light = light + window(d, {-0.8, -0.36, 0.48}, 0.95, 0.92) * Colour{0.2, 1.1, 1.5};
  light = light + window(d, {-0.28, 0.9, 0.33}, 0.94, 0.90) * Colour{1.7, 0.6, 0.2};
  light = light + window(d, {0.85, 0.5, -0.17}, 0.96, 0.93) * Colour{1.2, 0.2, 0.9};
  // A horizon of tiles.
  const double azimuth = std::atan2(d[1], d[0]) / (2 * std::numbers::pi);
  const double tile = smoothstep(-0.25, 0.25, std::sin(2 * std::numbers::pi * 10 * azimuth));
  const double band = smoothstep(-0.42, -0.36, d[2]) * smoothstep(-0.12, -0.18, d[2]);
  return light + band * tile * Colour{0.5, 0.42, 0.3};
}

bool is_inside(const SurfacePoint& point) {
  const auto& [x, y, z] = point.position;
  return z > 0.2 && point.normal[0] * x + point.normal[1] * y <= 0 && x * x + y * y < 0.09;
}

Colour vase_albedo(const SurfacePoint& point) {
  const auto& [x, y, z] = point.position;
  const double angle = std::atan2(y, x);
  static const Colour white = from_hex(0xf3efe4), cobalt = from_hex(0x1d3f8f),
                      gold = from_hex(0xd9a441);
  const double r = std::sqrt(x * x + y * y);
  if (is_inside(point)) return mix(from_hex(0x3a2c20), white, smoothstep(0.5, 0.76, z));
  // Two families of waves that cross make petals on the belly.
  const double left = std::sin(8 * angle + 9 * z), right = std::sin(8 * angle - 9 * z);
  const double petals =
      smoothstep(-0.1, 0.1, left * right) * smoothstep(-0.52, -0.46, z) * smoothstep(0.3, 0.24, z);
  const double veins = smoothstep(0.12, 0.06, std::abs(left * right));
  Colour colour = mix(white, cobalt, petals);
  colour = mix(colour, gold, veins * smoothstep(-0.52, -0.46, z) * smoothstep(0.3, 0.24, z));
  for (const double band : {-0.56, 0.36, 0.70})
    colour = mix(colour, band > 0.5 ? gold : cobalt, smoothstep(0.034, 0.026, std::abs(z - band)));
  const double along = std::remainder(angle, 2 * std::numbers::pi / 24) * r;
  const double dots = std::sqrt(along * along + (z + 0.56) * (z + 0.56));
  return mix(colour, white, smoothstep(0.016, 0.010, dots));
}

class Vase final : public Scene {
 public:
  Bounds bounds() const override {
    const double r = shape_.radius();
    return {{-r, -r, shape_.bottom()}, {r, r, shape_.top()}, 0.88};
  }
  int default_lattice() const override { return 200; }
  Mesh mesh() const override { return shape_.mesh(kMeshSegments); }
  void crossings(const Ray& ray, std::vector<SurfacePoint>& out) const override {
    shape_.crossings(ray, out);
  }
  Colour albedo(const SurfacePoint& point) const override { return vase_albedo(point); }
  bool radiance(const Ray& ray, Colour& light, double& transmittance) const override {
    const auto hit = shape_.nearest(ray);
    if (!hit) return false;
    const Vec3 to_eye = -1 * ray.direction;
    const double facing = std::max(0.0, dot(hit->normal, to_eye));
    // Schlick's Fresnel term of a glaze of refractive index 1.6; half of it at grazing angles, as
    // an uneven surface has it.
    const double mirror = 0.053 + 0.45 * power(1 - facing, 5);
    const Vec3 reflected = 2 * facing * hit->normal - to_eye;
    // The inside sees the room only through the opening.
    const double open = is_inside(*hit) ? smoothstep(0.45, 0.8, hit->position[2]) : 1;
    light = (1 - mirror) * shade(*hit, vase_albedo(*hit), to_eye, kGlaze, kVaseLamps) +
            2 * mirror * room(reflected);
    light = open * light;
    transmittance = 0;
    return true;
  }

 private:
  Revolution shape_{kOutline};
};

}  // namespace

std::unique_ptr<Scene> make_vase() { return std::make_unique<Vase>(); }

}  // namespace slf::synth
