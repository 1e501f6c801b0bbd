// SPDX-License-Identifier: Apache-2.0
#include "lightfield/colour.h"

#include <cmath>

#include "slf/view_map.h"

namespace slf {

std::array<std::array<double, 3>, 3> colour_matrix(ColourTransform transform) {
  if (transform == ColourTransform::kNone) return {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  // Columns are the orthonormal rows of the forward transform (spec 6.5).
  const double a = 1 / std::sqrt(3.0), b = 1 / std::sqrt(2.0), c = 1 / std::sqrt(6.0);
  return {{{a, b, c}, {a, 0, -2 * c}, {a, -b, c}}};
}

double srgb_to_linear(double display) {
  return display <= 0.04045 ? display / 12.92 : std::pow((display + 0.055) / 1.055, 2.4);
}

double linear_to_srgb(double linear) {
  return linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
}

}  // namespace slf
