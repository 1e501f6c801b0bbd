// SPDX-License-Identifier: Apache-2.0
#include "capture/gltf_transform.h"

#include <cmath>

#include "capture/json_numbers.h"

namespace slf {

NodeMatrix product(const NodeMatrix& a, const NodeMatrix& b) {
  NodeMatrix m{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      m[i][j] = j == 3 ? a[i][3] : 0;
      for (std::size_t k = 0; k < 3; ++k) m[i][j] += a[i][k] * b[k][j];
    }
  return m;
}

Vec3 moved_by(const NodeMatrix& m, const Vec3& p) {
  Vec3 out{};
  for (std::size_t i = 0; i < 3; ++i)
    out[i] = m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3];
  return out;
}

NodeMatrix cofactors(const NodeMatrix& m) {
  NodeMatrix c{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      const std::size_t i1 = (i + 1) % 3, i2 = (i + 2) % 3, j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      c[i][j] = m[i1][j1] * m[i2][j2] - m[i1][j2] * m[i2][j1];
    }
  return c;
}

bool mirrors(const NodeMatrix& m) {
  const NodeMatrix c = cofactors(m);
  return m[0][0] * c[0][0] + m[0][1] * c[0][1] + m[0][2] * c[0][2] < 0;
}

Result<NodeMatrix, InputError> transform_of(const JsonView& node) {
  NodeMatrix m{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
  if (const auto given = node.find("matrix")) {
    SLF_TRY(const auto values, json_vector<16>(*given));
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 4; ++j) m[i][j] = values[j * 4 + i];
    return m;
  }
  std::array<double, 4> q{0, 0, 0, 1};
  Vec3 scale{1, 1, 1}, translation{0, 0, 0};
  if (const auto given = node.find("rotation")) {
    SLF_TRY(q, json_vector<4>(*given));
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length)) return given->error("rotation of length 0");
    for (double& x : q) x /= length;
  }
  if (const auto given = node.find("scale")) {
    SLF_TRY(scale, json_vector<3>(*given));
  }
  if (const auto given = node.find("translation")) {
    SLF_TRY(translation, json_vector<3>(*given));
  }
  const auto [x, y, z, w] = q;
  m = {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0},
        {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0},
        {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) m[i][j] *= scale[j];
    m[i][3] = translation[i];
  }
  return m;
}

}  // namespace slf
