// SPDX-License-Identifier: Apache-2.0
// A wrap-around picture painted with antialiased shapes: the label of a can.
#pragma once

#include <string_view>
#include <vector>

#include "tools/synth/vec.h"

namespace slf::synth {

/// Coordinates are label units, u to the right (periodic), v up; colours linear light.
class Canvas {
 public:
  /// @param scale  texels per label unit; width * scale and height * scale are rounded up
  Canvas(double width, double height, double scale);

  void gradient(const Colour& bottom, const Colour& top);
  void rectangle(double u0, double v0, double u1, double v1, const Colour& colour);
  void disc(double u, double v, double radius, const Colour& colour);
  void ring(double u, double v, double radius, double thickness, const Colour& colour);
  void line(double u0, double v0, double u1, double v1, double thickness, const Colour& colour);
  /// Round-ended stroke letters, capitals and digits; centred on u, baseline at v.
  void text(std::string_view text, double u, double v, double height, double thickness,
            const Colour& colour);
  static double text_width(std::string_view text, double height);
  /// Every point: colour = shader(u, v, colour).
  template <class Shader>
  void apply(Shader&& shader);

  /// Bilinear; v is clamped.
  Colour at(double u, double v) const;

 private:
  template <class Distance>
  void paint(double u0, double v0, double u1, double v1, const Colour& colour, Distance&& distance);
  float* texel(int column, int row);

  int columns_, rows_;
  double across_, up_;  // texels per unit
  std::vector<float> texels_;
};

template <class Shader>
void Canvas::apply(Shader&& shader) {
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      float* p = texel(column, row);
      const Colour c =
          shader((column + 0.5) / across_, (row + 0.5) / up_, Colour{p[0], p[1], p[2]});
      for (int k = 0; k < 3; ++k) p[k] = static_cast<float>(c[std::size_t(k)]);
    }
}

}  // namespace slf::synth
