// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/terrace_finish.h"

#include <array>

#include "tools/synth/noise.h"
#include "tools/synth/shading.h"
#include "tools/synth/terrace_patterns.h"

namespace slf::synth {
namespace {

template <std::size_t N>
Colour pick(const std::array<std::uint32_t, N>& palette, std::uint32_t seed) {
  return from_hex(palette[mixed(seed, 70) % N]);
}

constexpr std::array<std::uint32_t, 5> kBricks{0x9c4a36, 0xa9583e, 0x8a4033, 0xc09a6b, 0xb5846a};
constexpr std::array<std::uint32_t, 8> kPlasters{0xf0e6d2, 0xe8c99a, 0xd9a38f, 0xb8cbd6,
                                                 0xe9d98f, 0xb9c9a5, 0xf2efe8, 0xc98f77};
constexpr std::array<std::uint32_t, 6> kDoors{0x1d3f72, 0x8f1d22, 0x1f5a3d,
                                              0x222428, 0xc78a1e, 0x5b2a5e};
constexpr std::array<std::uint32_t, 4> kRoofs{0x9a4f38, 0x55606c, 0xa65c40, 0x474e57};

/// Stains that are metres wide and grain that is centimetres wide.
double weather(const FaceCoordinates& at, std::uint32_t seed, double footprint) {
  const double grain = value_noise(31 * at.u, 31 * at.v, seed + 5) - 0.5;
  return 0.86 + 0.28 * cloudy_noise(0.6 * at.u, 0.45 * at.v, seed) +
         0.10 * grain * shown(0.03, footprint);
}

void brick(Finish& f, const Solid& solid, const FaceCoordinates& at, double footprint) {
  const Cell c = bond(at, {0.25, 0.085, 0.5}, solid.seed);
  const double seen = shown(0.085, footprint);
  const Colour base = pick(kBricks, solid.seed);
  const double joint = seen * (1 - smoothstep(0.006, 0.014, c.edge));
  const double varied = 1 + seen * 0.5 * (unit(c.bits) - 0.5);
  f.albedo =
      weather(at, solid.seed, footprint) * mix(varied * base, from_hex(0xb9ad9c), 0.65 * joint);
}

void stones(Finish& f, const Solid& solid, const FaceCoordinates& at, double footprint,
            const SurfacePoint& point) {
  const bool road = solid.surface == Surface::kSetts;
  const Cell c = bond(at, road ? Bond{0.30, 0.19, 0.5} : Bond{0.9, 0.6, 0.33}, 5);
  const double seen = shown(road ? 0.19 : 0.5, footprint);
  const double joint = seen * (1 - smoothstep(0.008, road ? 0.028 : 0.018, c.edge));
  const Colour base =
      road ? mix(from_hex(0x6d6a68), from_hex(0x8d8172), unit(c.bits) * seen + 0.5 * (1 - seen))
           : mix(from_hex(0xa39c8f), from_hex(0xb9b0a0), unit(c.bits) * seen + 0.5 * (1 - seen));
  // Wet where it is low: mirrors that stones stand out of.
  const double low = cloudy_noise(0.35 * at.u, 0.5 * at.v, 1234) + 0.12 * joint;
  const double damp = smoothstep(0.46, 0.6, low),
               puddle = road ? smoothstep(0.60, 0.68, low) : smoothstep(0.66, 0.72, low);
  f.albedo =
      weather(at, 99, footprint) * (1 - 0.45 * damp) * mix(base, from_hex(0x4a4640), 0.75 * joint);
  f.gloss = 0.015 + 0.10 * damp;
  f.exponent = 60;
  const double water = 0.04 * puddle;
  f.mirror = {water, water, water};
  // Every stone lies a little askew and is round at its edges; water is level.
  const double relief = (1 - puddle) * seen;
  const double round = 0.25 * (1 - smoothstep(0.0, 0.06, c.edge));
  const double tilt_u = relief * (0.10 * (unit(c.bits, 1) - 0.5) + round * c.towards_u);
  const double tilt_v = relief * (0.10 * (unit(c.bits, 2) - 0.5) + round * c.towards_v);
  if (point.normal[2] > 0.9) f.normal = normalised({tilt_u, tilt_v, 1});
}

/// Panes in painted wood in front of a dark room with curtains.
void finish_window(Finish& f, const Solid& solid, const SurfacePoint& point) {
  const double u = point.position[0], z = point.position[2];
  const double across = (u - solid.low[0]) / (solid.high[0] - solid.low[0]);
  const double up = (z - solid.low[2]) / (solid.high[2] - solid.low[2]);
  const double border =
      std::min({u - solid.low[0], solid.high[0] - u, z - solid.low[2], solid.high[2] - z});
  const double bars = std::min(std::abs(across - 0.5) * (solid.high[0] - solid.low[0]),
                               std::abs(up - 0.55) * (solid.high[2] - solid.low[2]));
  if (std::abs(point.normal[1]) < 0.5 || border < 0.065 || bars < 0.028) {
    f.albedo = from_hex(0xf3f0e9);
    f.gloss = 0.03;
    return;
  }
  const double drawn = 0.12 + 0.2 * unit(solid.seed, 3);
  const double fold = 0.8 + 0.2 * std::sin(70 * u + 6 * unit(solid.seed, 4));
  const bool curtain =
      std::min(across, 1 - across)<drawn, blind = up> 1 - 0.5 * unit(solid.seed, 5) &&
      unit(solid.seed, 6) < 0.4;
  const Colour cloth = mix(from_hex(0xb8ab98), from_hex(0x9a5f55), unit(solid.seed, 7));
  f.albedo = blind ? from_hex(0x9a9284) : curtain ? fold * 0.7 * cloth : from_hex(0x2a2e33);
  f.albedo = 0.5 * f.albedo;
  f.mirror = {0.16, 0.17, 0.18};
  // No two panes hang alike, and none is quite flat.
  const auto pane = static_cast<std::uint32_t>((across > 0.5 ? 1 : 0) + (up > 0.55 ? 2 : 0));
  const double a = 0.022 * (unit(solid.seed, 20 + pane) - 0.5) +
                   0.003 * std::sin(9 * u + 4 * z + 6 * unit(solid.seed, 8));
  const double b = 0.022 * (unit(solid.seed, 30 + pane) - 0.5) + 0.003 * std::sin(7 * z - 3 * u);
  f.normal = normalised(point.normal + Vec3{a, 0, b});
}

void door(Finish& f, const Solid& solid, const SurfacePoint& point) {
  const double across = (point.position[0] - solid.low[0]) / (solid.high[0] - solid.low[0]);
  const double up = (point.position[2] - solid.low[2]) / (solid.high[2] - solid.low[2]);
  const double u = std::abs(across - 0.5), v = std::abs(up - (up < 0.45 ? 0.25 : 0.7));
  const double inside = std::min({u - 0.07, 0.40 - u, (up < 0.45 ? 0.16 : 0.22) - v});
  f.albedo = (1 - 0.45 * (1 - smoothstep(0.0, 0.025, std::abs(inside)))) * pick(kDoors, solid.seed);
  f.gloss = 0.05;
  f.exponent = 120;
}

void tiles(Finish& f, const Solid& solid, const FaceCoordinates& at, double footprint) {
  const Cell c = bond(at, {0.24, 0.27, 0.5}, solid.seed);
  const double seen = shown(0.24, footprint);
  const double step = seen * (1 - smoothstep(0.0, 0.05, c.above)) +
                      0.5 * seen * (1 - smoothstep(0.004, 0.012, c.edge));
  f.albedo = weather(at, solid.seed, footprint) * (1 + seen * 0.35 * (unit(c.bits) - 0.5)) *
             (1 - 0.5 * std::min(step, 1.0)) * pick(kRoofs, solid.seed);
  f.gloss = 0.04;
  f.exponent = 18;
}

Colour plaster(const Solid& solid, double worn) {
  return (0.25 + 0.72 * worn) * pick(kPlasters, solid.seed);
}

void roof(Finish& f, const Solid& solid, const FaceCoordinates& at, double footprint) {
  const bool gable = std::abs(f.normal[0]) > 0.5;
  if (gable && solid.surface == Surface::kTilesOnBrick)
    brick(f, solid, at, footprint);
  else if (gable)
    f.albedo = plaster(solid, weather(at, solid.seed, footprint));
  else if (f.normal[2] < 0)
    f.albedo = from_hex(0xb79f86);  // boards under the eaves
  else
    tiles(f, solid, at, footprint);
}

void metal(Finish& f, const Colour& colour) {
  f.albedo = 0.04 * colour;
  f.mirror = colour;
}

void plain(Finish& f, const Solid& solid, const FaceCoordinates& at, double footprint) {
  const double worn = weather(at, solid.seed, footprint);
  switch (solid.surface) {
    case Surface::kPlaster:
      f.albedo = plaster(solid, worn);
      break;
    case Surface::kTrim:
      f.albedo = worn * from_hex(0xd8cfbd);
      break;
    case Surface::kGravel:
      f.albedo = worn * from_hex(0x8b867e);
      break;
    case Surface::kPottery:
      f.albedo = worn * from_hex(0xb5643f);
      break;
    case Surface::kBark:
      f.albedo = worn * from_hex(0x5b4635);
      break;
    case Surface::kLampGlass:
      f.albedo = from_hex(0xf4f1e4);
      f.mirror = {0.06, 0.06, 0.06};
      break;
    case Surface::kIron:
      f.albedo = from_hex(0x2b2f33);
      f.gloss = 0.06;
      break;
    default:
      break;
  }
}

void green(Finish& f, const Solid& solid, const SurfacePoint& point, const FaceCoordinates& at,
           double footprint) {
  if (solid.surface == Surface::kGrass) {
    const double tuft = shown(0.1, footprint) * (value_noise(14 * at.u, 14 * at.v, 3) - 0.5);
    const double patch = cloudy_noise(0.5 * at.u, 0.5 * at.v, 4);
    f.albedo = (1 + 0.5 * tuft) * mix(from_hex(0x5f7d36), from_hex(0x93994f), patch);
    return;
  }
  // Tufts of leaves that look different ways, dark where light does not reach between them.
  const auto bump = [&](double scale, std::uint32_t salt) {
    const Vec3 p = scale * point.position;
    return (value_noise(p[0] + 0.3 * p[1], p[2], salt) +
            value_noise(p[1] - 0.3 * p[2], p[0], salt) +
            value_noise(p[2] + 0.3 * p[0], p[1], salt)) /
               1.5 -
           1;
  };
  const double tuft = shown(0.2, footprint), leaf = 0.8 * shown(0.06, footprint);
  const auto relief = [&](std::uint32_t salt) {
    return tuft * bump(5, salt) + leaf * bump(17, salt);
  };
  f.normal = normalised(f.normal + 0.8 * Vec3{relief(1), relief(2), relief(3)});
  f.albedo =
      (1 + 0.6 * relief(4)) * mix(from_hex(0x426a2e), from_hex(0x6f8a3e), unit(solid.seed, 1));
  f.gloss = 0.02;
  f.exponent = 12;
}

void marble(Finish& f, const Solid& solid, const FaceCoordinates& at) {
  const double vein = std::abs(cloudy_noise(2.5 * at.u + at.v, 2.5 * at.v, solid.seed) - 0.5);
  f.albedo = mix(from_hex(0x9aa09f), from_hex(0xe9e6df), smoothstep(0, 0.09, vein));
  f.gloss = 0.05;
  f.exponent = 200;
}

}  // namespace

Finish finish(const Solid& solid, const SurfacePoint& point, double footprint) {
  Finish f{};
  f.normal = point.normal;
  const FaceCoordinates at = face_coordinates(solid, point);
  switch (solid.surface) {
    case Surface::kBrick:
      brick(f, solid, at, footprint);
      break;
    case Surface::kSetts:
    case Surface::kPaving:
      stones(f, solid, at, footprint, point);
      break;
    case Surface::kWindow:
      finish_window(f, solid, point);
      break;
    case Surface::kDoor:
      door(f, solid, point);
      break;
    case Surface::kTilesOnBrick:
    case Surface::kTilesOnPlaster:
      roof(f, solid, at, footprint);
      break;
    case Surface::kBrass:
      metal(f, {0.90, 0.66, 0.30});
      break;
    case Surface::kChrome:
      metal(f, {0.78, 0.79, 0.80});
      break;
    case Surface::kLeaves:
    case Surface::kGrass:
      green(f, solid, point, at, footprint);
      break;
    case Surface::kMarble:
      marble(f, solid, at);
      break;
    default:
      plain(f, solid, at, footprint);
      break;
  }
  for (double& c : f.albedo) c = std::clamp(c, 0.0, 0.95);
  return f;
}

}  // namespace slf::synth
