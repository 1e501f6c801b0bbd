// SPDX-License-Identifier: Apache-2.0
#include "tools/synth/canvas.h"

#include <limits>

namespace slf::synth {
namespace {

/// Letters as strokes on a 4 x 6 grid: "xy" pairs joined by lines, '|' lifts the pen.
std::string_view strokes(char letter) {
  switch (letter) {
    case 'A':
      return "002640|1232";
    case 'B':
      return "00063645443303|3342413000";
    case 'C':
      return "4536160501103041";
    case 'D':
      return "00062645412000";
    case 'E':
      return "46060040|0333";
    case 'F':
      return "460600|0333";
    case 'G':
      return "45361605011030414323";
    case 'H':
      return "0006|4046|0343";
    case 'I':
      return "2026";
    case 'K':
      return "0006|460340";
    case 'L':
      return "060040";
    case 'M':
      return "0006234640";
    case 'N':
      return "00064046";
    case 'O':
      return "100105163645413010";
    case 'P':
      return "00063645443303";
    case 'R':
      return "00063645443303|2340";
    case 'S':
      return "453616050413334241301001";
    case 'T':
      return "0646|2620";
    case 'U':
      return "060110304146";
    case '0':
      return "100105163645413010";
    case '3':
      return "05163645443323|334241301001";
    default:
      return "";
  }
}

double segment_distance(double u, double v, double u0, double v0, double u1, double v1) {
  const double du = u1 - u0, dv = v1 - v0;
  const double square = du * du + dv * dv;
  const double t =
      square > 0 ? std::clamp(((u - u0) * du + (v - v0) * dv) / square, 0.0, 1.0) : 0.0;
  return std::hypot(u - u0 - t * du, v - v0 - t * dv);
}

double stroke_distance(std::string_view glyph, double u, double v) {
  double nearest = std::numeric_limits<double>::infinity();
  bool down = false;
  double u0 = 0, v0 = 0;
  for (std::size_t i = 0; i < glyph.size();) {
    if (glyph[i] == '|' || i + 1 >= glyph.size()) {
      down = false;
      ++i;
      continue;
    }
    const double u1 = glyph[i] - '0', v1 = glyph[i + 1] - '0';
    if (down) nearest = std::min(nearest, segment_distance(u, v, u0, v0, u1, v1));
    u0 = u1;
    v0 = v1;
    down = true;
    i += 2;
  }
  return nearest;
}

constexpr double kAdvance = 5.6;  // grid units from letter to letter

}  // namespace

Canvas::Canvas(double width, double height, double scale)
    : columns_(static_cast<int>(std::ceil(width * scale))),
      rows_(static_cast<int>(std::ceil(height * scale))),
      across_(columns_ / width),
      up_(rows_ / height),
      texels_(std::size_t(columns_) * std::size_t(rows_) * 3) {}

float* Canvas::texel(int column, int row) {
  return &texels_[(std::size_t(row) * std::size_t(columns_) + std::size_t(column)) * 3];
}

template <class Distance>
void Canvas::paint(double u0, double v0, double u1, double v1, const Colour& colour,
                   Distance&& distance) {
  const int first_row = std::max(0, static_cast<int>(std::floor(v0 * up_)) - 1);
  const int last_row = std::min(rows_ - 1, static_cast<int>(std::ceil(v1 * up_)) + 1);
  const int first = static_cast<int>(std::floor(u0 * across_)) - 1;
  const int last = static_cast<int>(std::ceil(u1 * across_)) + 1;
  for (int row = first_row; row <= last_row; ++row)
    for (int column = first; column <= last; ++column) {
      const double d = distance((column + 0.5) / across_, (row + 0.5) / up_);
      const double cover = std::clamp(0.5 - d * across_, 0.0, 1.0);
      if (cover <= 0) continue;
      float* p = texel(((column % columns_) + columns_) % columns_, row);
      for (std::size_t k = 0; k < 3; ++k)
        p[k] = static_cast<float>(p[k] + cover * (colour[k] - double{p[k]}));
    }
}

void Canvas::gradient(const Colour& bottom, const Colour& top) {
  const double height = rows_ / up_;
  apply([&](double, double v, const Colour&) { return mix(bottom, top, v / height); });
}

void Canvas::rectangle(double u0, double v0, double u1, double v1, const Colour& colour) {
  paint(u0, v0, u1, v1, colour, [&](double u, double v) {
    return std::max({u0 - u, u - u1, v0 - v, v - v1});
  });
}

void Canvas::disc(double u, double v, double radius, const Colour& colour) {
  paint(u - radius, v - radius, u + radius, v + radius, colour,
        [&](double pu, double pv) { return std::hypot(pu - u, pv - v) - radius; });
}

void Canvas::ring(double u, double v, double radius, double thickness, const Colour& colour) {
  const double outer = radius + thickness;
  paint(u - outer, v - outer, u + outer, v + outer, colour, [&](double pu, double pv) {
    return std::abs(std::hypot(pu - u, pv - v) - radius) - thickness / 2;
  });
}

void Canvas::line(double u0, double v0, double u1, double v1, double thickness,
                  const Colour& colour) {
  paint(std::min(u0, u1) - thickness, std::min(v0, v1) - thickness, std::max(u0, u1) + thickness,
        std::max(v0, v1) + thickness, colour,
        [&](double u, double v) { return segment_distance(u, v, u0, v0, u1, v1) - thickness / 2; });
}

double Canvas::text_width(std::string_view text, double height) {
  return (kAdvance * static_cast<double>(text.size()) - (kAdvance - 4)) * height / 6;
}

void Canvas::text(std::string_view text, double u, double v, double height, double thickness,
                  const Colour& colour) {
  const double unit = height / 6;
  double pen = u - text_width(text, height) / 2;
  for (const char letter : text) {
    const std::string_view glyph = strokes(letter);
    if (!glyph.empty())
      paint(pen - thickness, v - thickness, pen + 4 * unit + thickness, v + height + thickness,
            colour, [&](double pu, double pv) {
              return stroke_distance(glyph, (pu - pen) / unit, (pv - v) / unit) * unit -
                     thickness / 2;
            });
    pen += kAdvance * unit;
  }
}

Colour Canvas::at(double u, double v) const {
  const double x = u * across_ - 0.5, y = std::clamp(v * up_ - 0.5, 0.0, rows_ - 1.0);
  const double x0 = std::floor(x);
  const int row = std::min(static_cast<int>(y), rows_ - 2);
  const double fx = x - x0, fy = y - row;
  const int wrapped = static_cast<int>(x0) % columns_;
  const int left = wrapped < 0 ? wrapped + columns_ : wrapped;
  const int right = left + 1 == columns_ ? 0 : left + 1;
  const float* below = &texels_[std::size_t(row) * std::size_t(columns_) * 3];
  const float* above = below + std::size_t(columns_) * 3;
  Colour result;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t l = std::size_t(left) * 3 + k, r = std::size_t(right) * 3 + k;
    result[k] = (1 - fy) * ((1 - fx) * below[l] + fx * below[r]) +
                fy * ((1 - fx) * above[l] + fx * above[r]);
  }
  return result;
}

}  // namespace slf::synth
