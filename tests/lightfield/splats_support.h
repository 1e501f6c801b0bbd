// SPDX-License-Identifier: Apache-2.0
// A ball whose points have harmonics that splats can hold exactly.
#pragma once

#include <cmath>
#include <random>

#include "slf/splats.h"
#include "tests/codec/field_support.h"

namespace slf::test {

/// Degree 3, every point another random map; up is +z unless it is changed.
inline LightField harmonic_ball(Directions frame, int bits = 4) {
  LightField field;
  LightFieldHeader& header = field.header;
  header.grid = {{-1, 2, 0.5}, 0.25, bits};
  header.basis = {BasisId::kHarmonics, 2, 0, 0, 3};
  header.num_functions = 16;
  header.shift.assign(16, 4);
  header.directions = frame;
  header.normal_cell_log2 = frame == Directions::kReflected ? 2 : 0;
  field.positions = sphere_cloud(bits);
  std::mt19937 random(5);
  for (std::size_t p = 0; p < field.positions.size(); ++p)
    for (int k = 0; k < 16; ++k)
      for (int c = 0; c < 3; ++c)
        field.components.push_back(k == 0 ? 16 * (90 + 30 * c)
                                          : static_cast<int>(random() % 129) - 64);
  return field;
}

}  // namespace slf::test
