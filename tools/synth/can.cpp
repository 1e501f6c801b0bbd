// SPDX-License-Identifier: Apache-2.0
// A slim beverage can: the paper's Can in spirit. Detailed label, four lamps, specular 0.5.
#include <array>
#include <numbers>

#include "tools/synth/canvas.h"
#include "tools/synth/revolution.h"
#include "tools/synth/scene.h"
#include "tools/synth/shading.h"

namespace slf::synth {
namespace {

constexpr double kRadius = 0.35;
constexpr double kLabelBottom = -0.69, kLabelTop = 0.58;
constexpr double kLabelWidth = 2 * std::numbers::pi * kRadius;
constexpr double kLabelHeight = kLabelTop - kLabelBottom;
constexpr double kTexelsPerUnit = 640;  // two per sample of a 256-pixel image

constexpr std::array<ProfileCorner, 11> kProfile{{{0, -0.745, 0},
                                                  {0.2, -0.775, 0.1},
                                                  {0.24, -0.8, 0.015},
                                                  {0.27, -0.8, 0.02},
                                                  {kRadius, -0.7, 0.08},
                                                  {kRadius, 0.6, 0.1},
                                                  {0.275, 0.755, 0.01},
                                                  {0.292, 0.768, 0.008},
                                                  {0.292, 0.8, 0.01},
                                                  {0.262, 0.765, 0.008},
                                                  {0, 0.765, 0}}};

constexpr std::array<Lamp, 4> kLamps{{{{5, -3, 1.8}, {0.72, 0.7, 0.66}},
                                      {{-4, -4, 0.3}, {0.46, 0.48, 0.52}},
                                      {{-3, 5, 3}, {0.62, 0.6, 0.57}},
                                      {{3, 4, -2.5}, {0.4, 0.42, 0.46}}}};
const Colour kAluminium = from_hex(0xc9ced4);
constexpr Material kPaint{0.8, 0.5, 50, {0.13, 0.135, 0.145}};
constexpr Material kMetal{0.8, 0.6, 36, {0.13, 0.135, 0.145}};

void paint_checks(Canvas& canvas, double v, const Colour& dark, const Colour& light) {
  constexpr int kColumns = 56;
  constexpr double kSide = kLabelWidth / kColumns;
  for (int row = 0; row < 2; ++row)
    for (int column = 0; column < kColumns; ++column)
      canvas.rectangle(column * kSide, v + row * kSide, (column + 1) * kSide, v + (row + 1) * kSide,
                       (row + column) % 2 == 0 ? dark : light);
  canvas.rectangle(0, v - 0.022, kLabelWidth, v - 0.010, light);
  canvas.rectangle(0, v + 2 * kSide + 0.010, kLabelWidth, v + 2 * kSide + 0.022, light);
}

/// Rays of light that leave a medallion, in two alternating colours.
void paint_rays(Canvas& canvas, double u, double v, const Colour& colour) {
  constexpr int kRays = 40;
  for (int i = 0; i < kRays; ++i) {
    const double angle = 2 * std::numbers::pi * i / kRays;
    const double inner = 0.405, outer = i % 2 == 0 ? 0.52 : 0.46;
    canvas.line(u + inner * std::cos(angle), v + inner * std::sin(angle),
                u + outer * std::cos(angle), v + outer * std::sin(angle), 0.012, colour);
  }
}

void paint_medallion(Canvas& canvas, double u, double v, const Colour& accent) {
  const Colour cream = from_hex(0xfff3dc), navy = from_hex(0x14233f);
  paint_rays(canvas, u, v, from_hex(0xffd166));
  canvas.disc(u, v, 0.385, cream);
  canvas.ring(u, v, 0.352, 0.016, accent);
  canvas.ring(u, v, 0.328, 0.006, navy);
  canvas.text("PLENO", u, v - 0.005, 0.125, 0.034, navy);
  canvas.line(u - 0.24, v - 0.055, u + 0.24, v - 0.055, 0.010, accent);
  canvas.text("LIGHT FIELD", u, v - 0.125, 0.042, 0.0095, navy);
  canvas.text("SODA", u, v - 0.215, 0.052, 0.013, accent);
  canvas.text("330 ML", u, v - 0.275, 0.026, 0.006, navy);
  // A rising sun above the name.
  for (int i = 0; i <= 8; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / 9;
    canvas.line(u + 0.075 * std::cos(angle), v + 0.175 + 0.075 * std::sin(angle),
                u + 0.115 * std::cos(angle), v + 0.175 + 0.115 * std::sin(angle), 0.010,
                from_hex(0xf4a024));
  }
  canvas.disc(u, v + 0.178, 0.052, from_hex(0xef5b3a));
  canvas.rectangle(u - 0.06, v + 0.124, u + 0.06, v + 0.168, cream);
}

void paint_small_print(Canvas& canvas, double u, double v) {
  const Colour ink = from_hex(0x14233f), white = from_hex(0xf6fbff);
  constexpr std::array<const char*, 9> kLines{"SURFACE LIGHT", "FIELD SODA", "CARBONATED",
                                              "DIRECTION",     "REFLECTED",  "MANUFACTURED",
                                              "IN A GRID OF",  "SPLINES",    "NO SUGAR 0 0 3"};
  for (std::size_t i = 0; i < kLines.size(); ++i)
    canvas.text(kLines[i], u, v - 0.036 * static_cast<double>(i), 0.021, 0.0055, ink);
  // Bar code: widths from a fixed congruential sequence.
  const double bottom = v - 0.50, top = v - 0.36;
  canvas.rectangle(u - 0.105, bottom - 0.015, u + 0.105, top + 0.015, white);
  std::uint32_t state = 7;
  for (double x = u - 0.09; x < u + 0.085;) {
    state = state * 1664525u + 1013904223u;
    const double bar = 0.004 + 0.003 * (state >> 30), gap = 0.004 + 0.003 * (state >> 28 & 3);
    canvas.rectangle(x, bottom, std::min(x + bar, u + 0.09), top, from_hex(0x101418));
    x += bar + gap;
  }
}

/// Bubbles of varying size between the medallions; a fixed congruential sequence places them.
void paint_bubbles(Canvas& canvas) {
  std::uint32_t state = 2019;
  const auto next = [&state] {
    state = state * 1664525u + 1013904223u;
    return static_cast<double>(state >> 8) / (1 << 24);
  };
  for (int i = 0; i < 170; ++i) {
    const double u = next() * kLabelWidth, v = 0.13 + next() * (kLabelHeight - 0.26);
    const double radius = 0.008 + 0.022 * next() * next();
    canvas.disc(u, v, radius, from_hex(i % 3 == 0 ? 0xa5dfe4 : i % 3 == 1 ? 0x58b3c6 : 0xc4efe9));
    canvas.disc(u - 0.3 * radius, v + 0.35 * radius, 0.3 * radius, from_hex(0xd9fbf5));
  }
}

Canvas paint_label() {
  Canvas canvas(kLabelWidth, kLabelHeight, kTexelsPerUnit);
  canvas.gradient(from_hex(0x6fc4d6), from_hex(0xd3f1ea));
  paint_bubbles(canvas);
  const double middle = kLabelHeight / 2;
  paint_medallion(canvas, 0.25 * kLabelWidth, middle, from_hex(0xd7263d));
  paint_medallion(canvas, 0.75 * kLabelWidth, middle, from_hex(0xd7263d));
  paint_small_print(canvas, 0, middle + 0.24);
  paint_small_print(canvas, 0.5 * kLabelWidth, middle + 0.24);
  const Colour cream = from_hex(0xfff3dc);
  paint_checks(canvas, 0.035, from_hex(0xd7263d), cream);
  paint_checks(canvas, kLabelHeight - 0.115, from_hex(0xd7263d), cream);
  return canvas;
}

/// The lid: pressed rings, the opening and its tab.
Colour lid_albedo(double x, double y) {
  static const Colour dark = from_hex(0x8a929b), tab = from_hex(0xd7263d);
  const double r = std::hypot(x, y);
  double groove = smoothstep(0.012, 0.006, std::abs(r - 0.225));
  groove = std::max(groove, smoothstep(0.010, 0.004, std::abs(std::hypot(x - 0.1, y) - 0.095)));
  const double lever = std::max(std::abs(x + 0.055) - 0.095, std::abs(y) - 0.042);
  const double hole = std::hypot(x + 0.095, y) - 0.024;
  Colour colour = mix(kAluminium, dark, groove);
  colour = mix(colour, tab, smoothstep(0.003, -0.003, lever));
  return mix(colour, dark, smoothstep(0.003, -0.003, hole));
}

class Can final : public Scene {
 public:
  Bounds bounds() const override {
    return {{-kRadius, -kRadius, shape_.bottom()},
            {kRadius, kRadius, shape_.top()},
            std::hypot(kRadius, shape_.top())};
  }
  int default_lattice() const override { return 255; }
  Mesh mesh() const override { return shape_.mesh(kMeshSegments); }
  void crossings(const Ray& ray, std::vector<SurfacePoint>& out) const override {
    shape_.crossings(ray, out);
  }
  Colour albedo(const SurfacePoint& point) const override {
    const auto& [x, y, z] = point.position;
    if (is_label(point))
      return label_.at((std::atan2(y, x) / (2 * std::numbers::pi) + 0.5) * kLabelWidth,
                       z - kLabelBottom);
    if (z > 0.75 && std::hypot(x, y) < 0.262) return lid_albedo(x, y);
    return kAluminium;
  }
  bool radiance(const Ray& ray, Colour& light, double& transmittance) const override {
    const auto hit = shape_.nearest(ray);
    if (!hit) return false;
    light = shade(*hit, albedo(*hit), -1 * ray.direction, is_label(*hit) ? kPaint : kMetal, kLamps);
    transmittance = 0;
    return true;
  }

 private:
  static bool is_label(const SurfacePoint& p) {
    return p.position[2] > kLabelBottom && p.position[2] < kLabelTop;
  }

  Revolution shape_{kProfile};
  Canvas label_ = paint_label();
};

}  // namespace

std::unique_ptr<Scene> make_can() { return std::make_unique<Can>(); }

}  // namespace slf::synth
