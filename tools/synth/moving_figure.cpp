// SPDX-License-Identifier: Apache-2.0
// A figure of capsules that walks: parts that move against each other, and hide one another.
#include <numbers>

#include "tools/synth/moving_scene.h"
#include "tools/synth/noise.h"

namespace slf::synth {
namespace {

constexpr double kStride = 2 * std::numbers::pi / 24;  // of a whole cycle of 24 frames
constexpr double kPath = 0.25;                         // radius of the circle that it walks on
constexpr double kPace = 0.02;                         // of its middle, a frame
constexpr double kHip = 0.02, kShoulder = 0.42;        // heights of joints
constexpr double kKnee = -0.36, kElbow = 0.16;
constexpr Material kFabric{0.85, 0.12, 14, {0.2, 0.2, 0.21}};

struct Cloth {
  std::uint32_t dark, light;
  double stripes;  ///< a unit of height
  std::uint32_t seed;
};

MovingPart limb(const Capsule& capsule, const Cloth& cloth,
                std::function<Vec3(const Vec3&, double)> place) {
  const Colour dark = from_hex(cloth.dark), light = from_hex(cloth.light);
  MovingPart part{capsule_mesh(capsule),
                  [=](const SurfacePoint& p) {
                    const auto& [x, y, z] = p.position;
                    const double weave = cloudy_noise(30 * x + 17 * z, 30 * y + 23 * z, cloth.seed);
                    const double stripe = std::sin(cloth.stripes * z * std::numbers::pi);
                    return (0.7 + 0.5 * weave) * mix(dark, light, smoothstep(-0.2, 0.2, stripe));
                  },
                  kFabric, std::move(place)};
  part.solid = capsule;
  return part;
}

/// The whole figure goes on, and rises twice a cycle.
Vec3 body_place(const Vec3& p, double time) {
  const double rise = 0.015 * std::cos(2 * kStride * time) - 0.02;
  return turned(p + Vec3{0, -kPath, rise}, {0, 0, 1}, kPace / kPath * time);
}

Vec3 swung(const Vec3& p, double height, double angle) {
  const Vec3 joint{0, 0, height};
  return joint + turned(p - joint, {0, 1, 0}, angle);
}

/// An upper and a lower half, on one side.
/// @param phase  of its swing; a knee bends backwards while its leg goes forward, an elbow the
///               other way and always a little
void add_leg(std::vector<MovingPart>& parts, double side, double phase) {
  const Cloth trousers{0x1f3a5f, 0x31588c, 14, 7};
  const auto thigh = [phase](double time) { return 0.5 * std::sin(kStride * time + phase); };
  const auto knee = [phase](double time) {
    return 0.35 + 0.35 * std::cos(kStride * time + phase + 2.6);
  };
  parts.push_back(limb(
      {{0, side, kHip - 0.02}, {0, side, kKnee}, 0.085}, trousers,
      [=](const Vec3& p, double time) { return body_place(swung(p, kHip, thigh(time)), time); }));
  parts.push_back(
      limb({{0, side, kKnee}, {0, side, -0.72}, 0.07}, trousers, [=](const Vec3& p, double time) {
        const Vec3 bent = swung(p, kKnee, knee(time));
        return body_place(swung(bent, kHip, thigh(time)), time);
      }));
}

void add_arm(std::vector<MovingPart>& parts, double side, double phase) {
  const Cloth sleeve{0xb3122b, 0xfff3dc, 18, 9}, skin{0xc98f6b, 0xd9a17d, 5, 11};
  const auto arm = [phase](double time) { return 0.45 * std::sin(kStride * time + phase); };
  const auto elbow = [phase](double time) {
    return -0.4 - 0.25 * std::sin(kStride * time + phase + 3);
  };
  parts.push_back(limb({{0, side, kShoulder}, {0, side, kElbow}, 0.06}, sleeve,
                       [=](const Vec3& p, double time) {
                         return body_place(swung(p, kShoulder, arm(time)), time);
                       }));
  parts.push_back(
      limb({{0, side, kElbow}, {0, side, -0.1}, 0.05}, skin, [=](const Vec3& p, double time) {
        const Vec3 bent = swung(p, kElbow, elbow(time));
        return body_place(swung(bent, kShoulder, arm(time)), time);
      }));
}

}  // namespace

MovingScene walking_figure() {
  std::vector<MovingPart> parts;
  parts.push_back(
      limb({{0, 0, 0.08}, {0, 0, 0.36}, 0.17}, {0xb3122b, 0xfff3dc, 18, 9}, body_place));
  parts.push_back(limb({{0, 0, 0.62}, {0, 0, 0.68}, 0.1}, {0xc98f6b, 0x5a3825, 4, 11}, body_place));
  add_leg(parts, -0.1, 0);
  add_leg(parts, 0.1, std::numbers::pi);
  add_arm(parts, -0.24, std::numbers::pi);
  add_arm(parts, 0.24, 0);
  return {
      std::move(parts), {{{5, -3, 4}, {0.85, 0.82, 0.76}}, {{-4, 4, 2}, {0.5, 0.5, 0.52}}}, 0.98};
}

}  // namespace slf::synth
