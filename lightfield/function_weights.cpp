// SPDX-License-Identifier: Apache-2.0
#include "lightfield/function_weights.h"

#include <algorithm>

#include "lightfield/view_planes.h"

namespace slf {

FunctionWeights::FunctionWeights(const LightField& field, int threads)
    : header_(needs_view_planes(field.header) ? view_header(field.header) : field.header),
      planes_(needs_view_planes(field.header) ? view_planes(field, threads)
                                              : std::vector<std::int32_t>()),
      components_(needs_view_planes(field.header)
                      ? std::span<const std::int32_t>(planes_)
                      : std::span<const std::int32_t>(field.components)),
      colours_(header_, false),
      table_(header_, threads) {}

void FunctionWeights::weights(std::size_t p, float* rgb) const {
  colours_.apply(components_.data() + p * 3 * size(), rgb);
}

void FunctionWeights::functions(const Vec3& direction, float* row) const {
  auto at = direction_of(direction);
  at[1] = std::clamp(at[1], static_cast<float>(header_.gamma_min_q7) / 127.0f,
                     static_cast<float>(header_.gamma_max_q7) / 127.0f);
  table_.evaluate(at, row);
}

Vec3 cube_direction(std::size_t face, double s, double t) {
  // 0 - x: no negative zero, which would turn theta at a pole.
  switch (face) {
    case 0:
      return {1, 0 - t, 0 - s};
    case 1:
      return {-1, 0 - t, s};
    case 2:
      return {s, 1, t};
    case 3:
      return {s, -1, 0 - t};
    case 4:
      return {s, 0 - t, 1};
    default:
      return {0 - s, 0 - t, -1};
  }
}

}  // namespace slf
