// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/moving_scene.h"

#include <memory>
#include <numbers>

#include "tools/synth/canvas.h"
#include "tools/synth/noise.h"
#include "tools/synth/scene.h"

namespace slf::synth {
namespace {

constexpr double kRadians = std::numbers::pi / 180;

const std::vector<Lamp> kStandingLamps{{{5, -3, 4}, {0.85, 0.82, 0.76}},
                                       {{-4, -4, 1}, {0.42, 0.45, 0.5}},
                                       {{-1, 5, 2}, {0.45, 0.44, 0.42}}};
constexpr Material kGloss{0.8, 0.45, 40, {0.16, 0.165, 0.175}};

/// The can of can.cpp, moved by `place`.
MovingPart can_part(std::function<Vec3(const Vec3&, double)> place) {
  const std::shared_ptr<Scene> can = make_can();
  const Scene::Bounds box = can->bounds();
  const double r = box.high[0];
  MovingPart part{split_long(can->mesh(), 0.08),
                  [can](const SurfacePoint& p) { return can->albedo(p); }, kGloss,
                  std::move(place)};
  part.solid = Capsule{{0, 0, box.low[2] + r}, {0, 0, box.high[2] - r}, r};
  return part;
}

/// About an upright axis, then about one that lies; never along an axis of the grid.
Vec3 turned_twice(const Vec3& p, double angle) {
  return turned(turned(p, {0, 0, 1}, 0.5 + angle), {0.8, 0.6, 0}, 0.35 + 0.75 * angle);
}

constexpr double kTubeHalf = 0.8, kTubeRadius = 0.19, kLobes = 0.14;

/// The tube at rest, upright: three lobes, so that a twist shows in its shape; round ends.
Vec3 tube_surface(double around, double along) {
  const double angle = 2 * std::numbers::pi * around;
  const double z = -std::cos(std::numbers::pi * along);  // -1 .. 1, rows are close at the ends
  const double radius =
      kTubeRadius * (1 + kLobes * std::cos(3 * angle)) * std::sqrt(std::max(0.0, 1 - power(z, 10)));
  return {radius * std::cos(angle), radius * std::sin(angle), kTubeHalf * z};
}

Canvas paint_tube() {
  constexpr double kWide = 2 * std::numbers::pi * kTubeRadius, kLong = 2 * kTubeHalf;
  Canvas canvas(kWide, kLong, 480);
  canvas.gradient(from_hex(0x2f7f86), from_hex(0xe9c46a));
  canvas.apply([](double u, double v, const Colour& c) {
    return (0.72 + 0.5 * cloudy_noise(u * 24, v * 24, 5)) * c;
  });
  for (int i = 0; i < 60; ++i) {
    const auto n = static_cast<std::uint32_t>(i);
    const double radius = 0.012 + 0.03 * unit(11, n);
    canvas.disc(unit(12, n) * kWide, unit(13, n) * kLong, radius,
                from_hex(i % 3 == 0   ? 0xd7263d
                         : i % 3 == 1 ? 0xfff3dc
                                      : 0x14233f));
  }
  for (int i = 0; i < 4; ++i)
    canvas.text("BENDING TUBE", kWide / 2, 0.22 + 0.37 * i, 0.1, 0.02, from_hex(0x14233f));
  return canvas;
}

/// Twisted about its axis, then bent sideways along an arc of a circle.
Vec3 tube_place(const Vec3& p, double time, double speed) {
  constexpr double kMostTwist = 2;  // radians either way, after some 90 frames of speed 1
  const double end = kMostTwist * std::sin(2 * kRadians * speed * time / kMostTwist);
  const double twist = (0.6 + end) * p[2] / (2 * kTubeHalf);
  const Vec3 q = turned(p, {0, 0, 1}, 0.4 + twist);
  const double curvature = 0.5 + 0.4 * std::sin(0.1 * speed * time);  // above 0
  const double angle = curvature * q[2];
  const double x = (1 - std::cos(angle)) / curvature + q[0] * std::cos(angle);
  const double z = std::sin(angle) / curvature - q[0] * std::sin(angle);
  return turned({x - 0.12, q[1], z}, {0.6, 0.8, 0}, 0.4);
}

MovingPart ball(const Vec3& centre, double radius, std::uint32_t rgb, std::uint32_t seed) {
  MovingPart part;
  part.solid = Capsule{centre, centre, radius};
  part.rest = capsule_mesh(*part.solid);
  const Colour colour = from_hex(rgb);
  part.albedo = [=](const SurfacePoint& p) {
    const Vec3 q = (1 / radius) * (p.position - centre);
    const double wave = 6 * q[0] + 2 * std::sin(4 * q[1]) + 5 * q[2];
    const Colour marbled = (0.6 + 0.4 * std::sin(wave)) * colour;
    return (0.8 + 0.4 * value_noise(9 * q[0] + 5 * q[2], 9 * q[1], seed)) * marbled;
  };
  part.material = kGloss;
  return part;
}

}  // namespace

MovingScene turning_can(double degrees_a_frame) {
  const double rate = degrees_a_frame * kRadians;
  MovingScene scene{
      {can_part([rate](const Vec3& p, double time) { return turned_twice(p, rate * time); })},
      kStandingLamps,
      make_can()->radius()};
  return scene;
}

MovingScene twisting_tube(double speed) {
  const auto canvas = std::make_shared<Canvas>(paint_tube());
  MovingPart part{
      grid_mesh(96, 160, tube_surface),
      [canvas](const SurfacePoint& p) {
        const double angle = std::atan2(p.position[1], p.position[0]);
        return canvas->at((angle + std::numbers::pi) * kTubeRadius, p.position[2] + kTubeHalf);
      },
      kGloss, [speed](const Vec3& p, double time) { return tube_place(p, time, speed); }};
  return {{std::move(part)}, kStandingLamps, 0.95};
}

MovingScene appearing_ball() {
  MovingPart can = can_part([](const Vec3& p, double time) {
    return 0.7 * turned(p, {0, 0, 1}, 3 * kRadians * time) + Vec3{-0.25, 0, 0};
  });
  MovingPart thing = ball({0.35, -0.2, -0.31}, 0.25, 0xf4a024, 3);
  thing.place = [](const Vec3& p, double) { return p; };
  thing.first_frame = 2;
  return {{std::move(can), std::move(thing)}, kStandingLamps, 0.85};
}

std::optional<MovingScene> make_moving_scene(const std::string& name) {
  const auto cloud = [](MovingScene scene, double noise = 0) {
    scene.cloud = true;
    scene.noise = noise;
    return scene;
  };
  if (name == "still") return cloud(turning_can(0));
  if (name == "noise") return cloud(turning_can(0), 0.3);
  if (name == "rot1") return cloud(turning_can(1));
  if (name == "rot4") return cloud(turning_can(4));
  if (name == "tube2") return cloud(twisting_tube(1));
  if (name == "tube8") return cloud(twisting_tube(4));
  if (name == "turn") return turning_can(4);
  if (name == "twist") return twisting_tube(2);
  if (name == "walk") return walking_figure();
  if (name == "appear") return appearing_ball();
  return std::nullopt;
}

std::string moving_scene_names() {
  return "turn, twist, walk, appear, still, noise, rot1, rot4, tube2, tube8";
}

}  // namespace slf::synth
