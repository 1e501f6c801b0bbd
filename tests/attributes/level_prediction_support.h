// SPDX-License-Identifier: Apache-2.0
// Fields that prediction between levels is for.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

#include "attributes/level_prediction.h"
#include "attributes/raht_tree.h"
#include "tests/codec/field_support.h"

namespace slf::test {

using Values = std::vector<std::int32_t>;

/// Smooth over space, with a little noise: what prediction is for.
inline LightField smooth_field(const std::vector<Voxel>& voxels, int bits, int functions) {
  LightField field = test::make_field(voxels, bits, functions);
  std::mt19937 random(3);
  std::size_t i = 0;
  for (const Voxel& v : field.positions)
    for (int j = 0; j < 3 * functions; ++j)
      field.components[i++] =
          static_cast<std::int32_t>(1000 * std::sin((v[0] + (j + 1) * v[1] + 2 * v[2]) * 0.1)) +
          static_cast<std::int32_t>(random() % 21);
  return field;
}

}  // namespace slf::test
