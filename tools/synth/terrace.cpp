// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace.h"

#include <limits>

#include "tools/synth/noise.h"
#include "tools/synth/shading.h"
#include "tools/synth/terrace_build.h"
#include "tools/synth/terrace_finish.h"
#include "tools/synth/terrace_sky.h"

namespace slf::synth {
namespace {

constexpr double kOff = 1e-3;  // metres that rays start above a surface
constexpr double kPixel =
    1.1e-3;  // metres of a pixel at a distance of one: 60 degrees, 1000 pixels

std::uint32_t short_seed(std::uint64_t seed) {
  return mixed(static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32));
}

std::vector<Solid> build(const Plan& plan, std::uint32_t seed) {
  std::vector<Solid> solids;
  solids.reserve(plan.lots.size() * 128 + 64);
  build_streets(plan, seed, solids);
  for (const Lot& lot : plan.lots) build_house(lot, solids);
  return solids;
}

/// Schlick's approximation (1994), for every channel.
Colour fresnel(const Colour& straight, double cosine) {
  const double rest = power(1 - std::clamp(cosine, 0.0, 1.0), 5);
  return straight + rest * (Colour{1, 1, 1} - straight);
}

}  // namespace

/// What reaches a surface and leaves it again.
struct Terrace::Lit {
  Finish look;
  Colour light;  ///< that leaves it in all directions
  double sun;    ///< share of the sun that is not hidden
  double open;   ///< share of the sky
};

Terrace::Terrace(int houses, std::uint64_t seed)
    : plan_(make_plan(houses, short_seed(seed))), tree_(build(plan_, short_seed(seed))) {}

double Terrace::radius() const { return std::numeric_limits<double>::infinity(); }

bool Terrace::exposed(const SurfacePoint& point) const {
  return point.position[2] >= -1e-9 && !tree_.inside(point.position + kOff * point.normal);
}

/// How much of the sky is not behind houses, roughly: little at the foot of walls, all at roofs.
double Terrace::openness(const SurfacePoint& point) const {
  const Vec3& p = point.position;
  const double height = smoothstep(-1, 11, p[2]);
  const double street =
      plan_.street_y(0) +
      kStreetPitch * std::clamp(std::round((p[1] - plan_.street_y(0)) / kStreetPitch), 0.0,
                                plan_.streets - 1.0);
  const double y = std::abs(p[1] - street);
  const double wall = y < kFrontAt ? kFrontAt - y : std::max(0.0, y - kFrontAt - kHouseDepth);
  if (point.normal[2] > 0.7) {
    const double at_wall =
        std::abs(p[0]) < plan_.length / 2 ? 0.5 + 0.35 * smoothstep(0, 4, wall) : 0.9;
    return std::max(height, at_wall);
  }
  return (0.55 + 0.45 * height) * (0.7 + 0.3 * smoothstep(0, 0.8, p[2]));
}

Terrace::Lit Terrace::lit(const Solid& solid, const SurfacePoint& point, double footprint) const {
  Lit lit{finish(solid, point, footprint), {}, 0, openness(point)};
  const double cosine = dot(point.normal, to_sun());
  if (cosine > 0 && !tree_.blocked({point.position + kOff * point.normal, to_sun()})) lit.sun = 1;
  const double relief = std::max(0.0, dot(lit.look.normal, to_sun()));
  const Colour arrives = lit.sun * relief * kSunlight + lit.open * skylight(point.normal);
  lit.light = lit.look.albedo * arrives;
  return lit;
}

Colour Terrace::diffuse(const Solid& solid, const SurfacePoint& point, double footprint) const {
  return lit(solid, point, footprint).light;
}

/// What a mirror shows: the scene without its own reflections, or the sky.
Colour Terrace::reflected(const Vec3& from, const Vec3& direction, double footprint) const {
  const auto hit = tree_.nearest({from, direction});
  if (!hit) return direction[2] < -1e-3 ? country(from, direction) : sky(direction);
  const Lit l = lit(*hit->solid, hit->point, footprint + kPixel * hit->t);
  const double cosine = -dot(direction, hit->point.normal);
  const Colour share = fresnel(l.look.mirror, cosine);
  const bool mirrors = l.look.mirror[0] > 0;
  return mirrors ? l.light + l.open * (share *
                                       plain_sky(direction - 2 * dot(direction, hit->point.normal) *
                                                                 hit->point.normal))
                 : l.light;
}

bool Terrace::radiance(const Ray& ray, Colour& light, double& transmittance) const {
  transmittance = 0;
  const auto hit = tree_.nearest(ray);
  if (!hit) {
    light = ray.direction[2] < -1e-3 ? country(ray.origin, ray.direction) : sky(ray.direction);
    return true;
  }
  const double footprint = kPixel * hit->t;
  const Lit l = lit(*hit->solid, hit->point, footprint);
  light = l.light;
  const Vec3& n = l.look.normal;
  const double cosine = -dot(n, ray.direction);
  Vec3 mirrored = ray.direction + 2 * cosine * n;
  const double sunk = dot(mirrored, hit->point.normal);  // of relief that looks away
  if (sunk < 0.01) mirrored = normalised(mirrored + (0.01 - sunk) * hit->point.normal);
  if (l.look.mirror[0] > 0) {
    const Colour share = fresnel(l.look.mirror, cosine);
    const Colour shown =
        reflected(hit->point.position + kOff * hit->point.normal, mirrored, footprint);
    light = (Colour{1, 1, 1} - share) * light + share * shown;
  }
  if (l.look.gloss > 0) {
    const double share =
        l.look.gloss + 0.5 * l.look.gloss * power(1 - std::clamp(cosine, 0.0, 1.0), 4) * 8;
    const double lobe =
        power(std::max(0.0, dot(n, normalised(to_sun() - ray.direction))), l.look.exponent);
    light =
        light + std::min(share, 0.6) * (l.open * plain_sky(mirrored) +
                                        l.sun * (l.look.exponent + 8) / 16.0 * lobe * kSunlight);
  }
  return true;
}

}  // namespace slf::synth
