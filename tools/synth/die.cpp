// SPDX-License-Identifier: Apache-2.0
// A rounded die: the paper's Die in spirit. Three lamps, specular, a fifth of the light passes
// straight through, so that the pips of the far side shine dimly from everywhere.
#include <array>
#include <optional>

#include "tools/synth/scene.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr double kHalf = 0.5, kRounding = 0.11;
constexpr double kTransmittance = 0.2;
constexpr double kPipRadius = 0.092, kPipOffset = 0.24;

constexpr std::array<Lamp, 3> kDieLamps{{{{4, -4, 4.5}, {0.9, 0.88, 0.84}},
                                         {{-5, -2, 1}, {0.6, 0.62, 0.66}},
                                         {{1, 5, -3}, {0.62, 0.62, 0.62}}}};
constexpr Material kPlastic{0.8, 0.5, 50, {0.26, 0.26, 0.26}};

double square(double x) { return x * x; }

/// Signed distance to the rounded cube.
double distance(const Vec3& p) {
  constexpr double kFlat = kHalf - kRounding;
  const double x = std::abs(p[0]) - kFlat, y = std::abs(p[1]) - kFlat, z = std::abs(p[2]) - kFlat;
  const double inside = std::min(std::max({x, y, z}), 0.0);
  const double a = std::max(x, 0.0), b = std::max(y, 0.0), c = std::max(z, 0.0);
  return std::sqrt(a * a + b * b + c * c) + inside - kRounding;
}

Vec3 normal_at(const Vec3& p) {
  constexpr double kFlat = kHalf - kRounding;
  Vec3 n;
  for (std::size_t k = 0; k < 3; ++k) n[k] = p[k] - std::clamp(p[k], -kFlat, kFlat);
  return normalised(n);
}

/// First crossing from t on, by sphere tracing; the surface is convex and the distance exact.
std::optional<double> march(const Ray& ray, double t, double t_end) {
  constexpr int kMostSteps = 96;
  for (int i = 0; i < kMostSteps && t < t_end; ++i) {
    const double d = distance(ray.at(t));
    if (d < 1e-5) return t;  // a fiftieth of the thinnest pixel
    t += d;
  }
  return std::nullopt;
}

struct Passage {
  SurfacePoint in, out;
};

std::optional<Passage> pass(const Ray& ray) {
  // Where the line is inside the bounding cube.
  double enter = -1e30, leave = 1e30;
  for (std::size_t k = 0; k < 3; ++k) {
    if (std::abs(ray.direction[k]) < 1e-12) {
      if (std::abs(ray.origin[k]) > kHalf) return std::nullopt;
      continue;
    }
    const double a = (-kHalf - ray.origin[k]) / ray.direction[k];
    const double b = (kHalf - ray.origin[k]) / ray.direction[k];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter >= leave) return std::nullopt;
  const auto in = march(ray, enter, leave);
  if (!in) return std::nullopt;
  const Ray back{ray.at(leave), -1 * ray.direction};
  const auto from_leave = march(back, 0, leave - *in);
  const Vec3 p = ray.at(*in), q = from_leave ? back.at(*from_leave) : p;
  return Passage{{p, normal_at(p)}, {q, normal_at(q)}};
}

/// Pips of a face in units of kPipOffset; opposite faces sum to seven.
struct Pips {
  int count;
  std::array<std::array<int, 2>, 6> at;
};
constexpr std::array<Pips, 6> kPips{{{1, {{{0, 0}}}},
                                     {6, {{{-1, -1}, {-1, 0}, {-1, 1}, {1, -1}, {1, 0}, {1, 1}}}},
                                     {2, {{{-1, -1}, {1, 1}}}},
                                     {5, {{{-1, -1}, {-1, 1}, {0, 0}, {1, -1}, {1, 1}}}},
                                     {3, {{{-1, 1}, {0, 0}, {1, -1}}}},
                                     {4, {{{-1, -1}, {-1, 1}, {1, -1}, {1, 1}}}}}};

Colour die_albedo(const SurfacePoint& point) {
  const Vec3& n = point.normal;
  std::size_t axis = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(n[k]) > std::abs(n[axis])) axis = k;
  const Pips& pips = kPips[2 * axis + (n[axis] > 0 ? 0 : 1)];
  const double a = point.position[(axis + 1) % 3], b = point.position[(axis + 2) % 3];
  double nearest = 1;
  for (std::size_t i = 0; i < static_cast<std::size_t>(pips.count); ++i)
    nearest = std::min(
        nearest, square(a - kPipOffset * pips.at[i][0]) + square(b - kPipOffset * pips.at[i][1]));
  nearest = std::sqrt(nearest);
  // Slight marbling of the plastic, so that no face is flat.
  const auto& [x, y, z] = point.position;
  const double vein = 0.5 + 0.5 * std::sin(9 * x + 4 * std::sin(5 * y + 2 * z) + 7 * z);
  static const Colour kDark = from_hex(0xb3122b), kLight = from_hex(0xe0453f);
  static const Colour kRim = from_hex(0x6d0a1c), kWhite = from_hex(0xfdf6e6);
  const Colour body = mix(kDark, kLight, vein);
  const Colour rimmed = mix(kRim, body, smoothstep(kPipRadius, kPipRadius + 0.016, nearest));
  return mix(kWhite, rimmed, smoothstep(kPipRadius - 0.008, kPipRadius, nearest));
}

class Die final : public Scene {
 public:
  Bounds bounds() const override {
    const double corner = std::sqrt(3.0) * (kHalf - kRounding) + kRounding;
    return {{-kHalf, -kHalf, -kHalf}, {kHalf, kHalf, kHalf}, corner};
  }
  int default_lattice() const override { return 127; }
  void crossings(const Ray& ray, std::vector<SurfacePoint>& out) const override {
    const auto passage = pass(ray);
    if (!passage) return;
    out.push_back(passage->in);
    out.push_back(passage->out);
  }
  Colour albedo(const SurfacePoint& point) const override { return die_albedo(point); }
  bool radiance(const Ray& ray, Colour& light, double& transmittance) const override {
    const auto passage = pass(ray);
    if (!passage) return false;
    const Vec3 to_eye = -1 * ray.direction;
    // The far wall glows with the light that falls on it from outside.
    const Colour far = shade(passage->out, die_albedo(passage->out), to_eye,
                             Material{kPlastic.diffuse, 0, 0, kPlastic.ambient}, kDieLamps);
    const Material wall{kPlastic.diffuse * (1 - kTransmittance), kPlastic.specular,
                        kPlastic.exponent, kPlastic.ambient};
    light = shade(passage->in, die_albedo(passage->in), to_eye, wall, kDieLamps) +
            kTransmittance * (1 - kTransmittance) * far;
    transmittance = kTransmittance * kTransmittance;
    return true;
  }
};

}  // namespace

std::unique_ptr<Scene> make_die() { return std::make_unique<Die>(); }

}  // namespace slf::synth
