// SPDX-License-Identifier: Apache-2.0
// Colours of many points at once, as a renderer asks for them.
#include <algorithm>
#include <cmath>

#include "base/multiversion.h"
#include "lightfield/function_table.h"
#include "lightfield/harmonics.h"
#include "slf/view_map.h"

namespace slf {
namespace {

constexpr std::size_t kLanes = Harmonics::kLanes;

std::array<float, 3> unit(const Vec3& from, const Vec3& to) {
  const Vec3 v{to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  const double square = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
  if (!(square > 0)) return {1, 0, 0};  // as direction_of(0, 0, 0)
  const double scale = 1 / std::sqrt(square);
  return {float(v[0] * scale), float(v[1] * scale), float(v[2] * scale)};
}

/// With z, which is gamma, in low .. high, and theta as it was.
std::array<float, 3> with_gamma(std::array<float, 3> v, float low, float high) {
  const float gamma = std::min(std::max(v[2], low), high);
  if (gamma == v[2]) return v;
  const float across = std::hypot(v[0], v[1]);
  const float length = std::sqrt(std::max(0.0f, 1 - gamma * gamma));
  if (!(across > 0)) return {length, 0, gamma};
  return {v[0] * length / across, v[1] * length / across, gamma};
}

/// Asks for values that are needed soon: points come in no order of memory.
inline void prefetch([[maybe_unused]] const float* values, [[maybe_unused]] std::size_t count) {
#if defined(__GNUC__)
  for (std::size_t i = 0; i < count; i += 64 / sizeof(float)) __builtin_prefetch(values + i);
#endif
}

/// Sums of the functions, channel by channel, kLanes at a time.
/// @param weights  [3][count]
inline std::array<float, 3> weighted_sum(const float* row, const float* weights,
                                         std::size_t count) {
  std::array<float, 3> rgb;
  for (std::size_t c = 0; c < 3; ++c, weights += count) {
    std::array<float, kLanes> sums{};
    std::size_t k = 0;
    for (; k + kLanes <= count; k += kLanes)
      for (std::size_t j = 0; j < kLanes; ++j) sums[j] += row[k + j] * weights[k + j];
    for (std::size_t j = 0; k + j < count; ++j) sums[j] += row[k + j] * weights[k + j];
    const float sum =
        ((sums[0] + sums[4]) + (sums[2] + sums[6])) + ((sums[1] + sums[5]) + (sums[3] + sums[7]));
    rgb[c] = std::clamp(sum, 0.0f, 255.0f);
  }
  return rgb;
}

}  // namespace

std::array<float, 3> ViewMaps::seen_from(std::size_t p, const Vec3& eye) const {
  const Vec3 at = header_.grid.world(positions_[p]);
  const auto [theta, gamma] = direction_of({eye[0] - at[0], eye[1] - at[1], eye[2] - at[2]});
  return radiance(p, theta, gamma);
}

SLF_MULTIVERSION_ALL
void ViewMaps::radiances(const Vec3& eye, std::span<const std::uint32_t> points,
                         std::span<std::array<float, 3>> colours) const {
  if (header_.basis.id != BasisId::kHarmonics) {
    for (std::size_t i = 0; i < points.size(); ++i) colours[i] = seen_from(points[i], eye);
    return;
  }
  const float low = static_cast<float>(header_.gamma_min_q7) / 127.0f;
  const float high = static_cast<float>(header_.gamma_max_q7) / 127.0f;
  std::array<std::array<float, kLanes>, 3> directions{};
  std::array<std::array<float, kLanes>, Harmonics::kMost> rows;
  std::array<float, Harmonics::kMost + 2 * kLanes> row;  // what FunctionTable adds
  for (std::size_t first = 0; first < points.size(); first += kLanes) {
    const std::size_t count = std::min(kLanes, points.size() - first);
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t p = points[first + i];
      prefetch(nodes_.data() + p * 3 * width_, 3 * width_);
      auto w = unit(header_.grid.world(positions_[p]), eye);
      if (!mirror_normals_.empty()) {  // mirrored at the normal, spec 6.4
        const auto& n = mirror_normals_[p];
        const float twice = 2 * (w[0] * n[0] + w[1] * n[1] + w[2] * n[2]);
        w = {twice * n[0] - w[0], twice * n[1] - w[1], twice * n[2] - w[2]};
      }
      w = with_gamma(w, low, high);
      for (std::size_t k = 0; k < 3; ++k) directions[k][i] = w[k];
    }
    if (harmonics_) harmonics_->evaluate(directions, rows.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (harmonics_) {
        for (std::size_t k = 0; k < width_; ++k) row[k] = rows[k][i];
      } else {
        table_->look_up({directions[0][i], directions[1][i], directions[2][i]}, row.data());
      }
      colours[first + i] =
          weighted_sum(row.data(), nodes_.data() + points[first + i] * 3 * width_, width_);
    }
  }
}

}  // namespace slf
