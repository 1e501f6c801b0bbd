// SPDX-License-Identifier: Apache-2.0
// Eight surfels in one picture: Q = A A^T + filter^2 I with A the radii in pixels; Zwicker et al.
// (2002).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "encoder/train/draw_surfels.h"
#include "encoder/train/surfel_lanes.h"
#include "encoder/train/tile_pixels.h"
#include "lightfield/render/reference_kernel.h"

namespace slf {

inline constexpr auto kFilterSquare =
    float(kReferenceKernel.filter_pixels * kReferenceKernel.filter_pixels);
inline constexpr float kGaussianFilter = GaussianKernel::filter * kGaussianReach;  // squared radii
inline constexpr float kNearest = 0.02f;      // of the camera's depth: nearer, a disc is no ellipse
inline constexpr float kLeastCosine = 0.15f;  // a flatter plane's depth says nothing
inline constexpr float kLeastOpacity = 1.0f / 255;
inline constexpr float kMostSlope = 1.3f;  // times the picture: beyond, nothing is linear

using Lanes3 = Three<Lanes>;
using SurfelRows = std::array<const float*, kLaneCount>;
using SurfelColumns = std::array<Lanes, TrainedSurfel::kSize>;

/// Eight surfels, with what their gradients need again.
struct Projections {
  SurfelColumns value;                         // TrainedSurfel
  UnitTurn<Lanes> turn;                        // world
  Lanes3 at;                                   // of the centres, in the camera
  Three<Lanes3> axes;                          // in the camera; the third is the normal
  Lanes3 radius;                               // a disc's third is 0
  std::array<Lanes, 2> slope;                  // x / z and y / z as the Jacobian has them
  std::array<LaneMask, 2> clamped;             // they are not those of `at`
  std::array<std::array<Lanes, 2>, 2> scale;   // [u, v]: d / dx or d / dy, and d / dz
  std::array<std::array<Lanes, 2>, 3> across;  // [axis][u, v] A
  Lanes plane;                                 // normal . at, kept off 0
  LaneMask grazing;                            // it was
  Lanes3 direction;                            // from the camera's centre, unit
  Lanes distance;
  // ProjectedSurfel
  Lanes u{}, v{}, a{}, b{}, c{}, reach{}, half_width{}, half_height{}, opacity{};
  Lanes3 colour{};
  Lanes near{}, near_du{}, near_dv{};
};

template <class T>
[[gnu::always_inline]] inline void set_dot(const Three<T>& a, const Lanes3& b, Lanes& product) {
  product = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

[[gnu::always_inline]] inline void set_turned(const std::array<Float3, 3>& rotation,
                                              const Lanes3& v, Lanes3& turned) {
  for (std::size_t r = 0; r < 3; ++r) set_dot(rotation[r], v, turned[r]);
}

/// R^T v
[[gnu::always_inline]] inline void set_turned_back(const std::array<Float3, 3>& rotation,
                                                   const Lanes3& v, Lanes3& turned) {
  turned = {};
  for (std::size_t r = 0; r < 3; ++r)
    for (std::size_t a = 0; a < 3; ++a) turned[a] += v[r] * rotation[r][a];
}

template <class Function>
[[gnu::always_inline]] inline void set_each(const Lanes& x, Lanes& y, const Function& function) {
  std::array<float, kLaneCount> values;
  std::memcpy(values.data(), &x, sizeof x);
  for (float& value : values) value = function(value);
  std::memcpy(&y, values.data(), sizeof y);
}

[[gnu::always_inline]] inline void limit(const Lanes& low, const Lanes& high, Lanes& x) {
  x = x < low ? low : high < x ? high : x;
}

/// What the picture's derivatives take for x / z: clamped far outside of the picture.
[[gnu::always_inline]] inline void set_slope(float focal, float principal, int size,
                                             const Lanes& at, Lanes& slope, LaneMask& clamped) {
  const float low = -kMostSlope * principal / focal;
  const float high = kMostSlope * (float(size) - principal) / focal;
  slope = at;
  limit(Lanes{} + std::min(low, 0.0f), Lanes{} + std::max(high, 0.0f), slope);
  clamped = slope != at;
}

/// @return those that are before the camera, and not faint
[[gnu::always_inline]] inline LaneMask set_centres(const SurfelRows& rows,
                                                   const TrainingCamera& camera, Projections& p) {
  load_rows(rows, p.value);
  const Lanes3 position = {p.value[0], p.value[1], p.value[2]};
  set_turned(camera.rotation, position, p.at);
  for (std::size_t a = 0; a < 3; ++a) p.at[a] += camera.translation[a];
  const auto& [x, y, z] = p.at;
  set_each(p.value[TrainedSurfel::kOpacity], p.opacity,
           [](float logit) { return 1 / (1 + std::exp(-logit)); });
  p.u = camera.fx * x / z + camera.cx;
  p.v = camera.fy * y / z + camera.cy;
  return (z > kNearest * camera.depth) & (p.opacity > kLeastOpacity);
}

/// Squared radii at which alpha is 1/255, where GaussianRenderer ends it: 0 .. 1
[[gnu::always_inline]] inline void set_reach(bool gaussian, Projections& p) {
  p.reach = Lanes{} + 1.0f;
  if (!gaussian) return;
  Lanes logarithm;
  set_each(p.opacity, logarithm, [](float x) { return std::log(x); });
  p.reach = 1 + 2 * logarithm / kGaussianReach;
  limit(Lanes{}, Lanes{} + 1.0f, p.reach);
}

[[gnu::always_inline]] inline void set_across(const TrainingCamera& camera, Projections& p) {
  const auto& [x, y, z] = p.at;
  set_unit_turn(&p.value[TrainedSurfel::kTurn], p.turn);
  Three<Lanes3> axes;
  set_axes(p.turn, axes);
  for (std::size_t k = 0; k < 3; ++k) {
    set_turned(camera.rotation, axes[k], p.axes[k]);
    set_each(p.value[TrainedSurfel::kLogRadius + k], p.radius[k],
             [](float log) { return std::exp(log); });
  }
  if (!camera.gaussian) p.radius[2] = Lanes{};
  set_slope(camera.fx, camera.cx, camera.width, x / z, p.slope[0], p.clamped[0]);
  set_slope(camera.fy, camera.cy, camera.height, y / z, p.slope[1], p.clamped[1]);
  p.scale[0] = {camera.fx / z, -camera.fx * p.slope[0] / z};
  p.scale[1] = {camera.fy / z, -camera.fy * p.slope[1] / z};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t i = 0; i < 2; ++i)
      p.across[k][i] = p.radius[k] * (p.scale[i][0] * p.axes[k][i] + p.scale[i][1] * p.axes[k][2]);
}

/// @return those that a pixel can show
[[gnu::always_inline]] inline LaneMask set_ellipse(const TrainingCamera& camera, Projections& p) {
  set_reach(camera.gaussian, p);
  set_across(camera, p);
  Lanes uu = Lanes{} + (camera.gaussian ? kGaussianFilter : kFilterSquare), uv{}, vv = uu;
  for (const auto& axis : p.across) {
    uu += axis[0] * axis[0];
    uv += axis[0] * axis[1];
    vv += axis[1] * axis[1];
  }
  const Lanes determinant = uu * vv - uv * uv;
  p.a = vv / determinant;
  p.b = -uv / determinant;
  p.c = uu / determinant;
  set_root(uu * p.reach, p.half_width);
  set_root(vv * p.reach, p.half_height);
  return (determinant > 0.0f) & (determinant - determinant == 0.0f) &  // no infinity
         (p.u + p.half_width > 0.0f) & (p.u - p.half_width < float(camera.width)) &
         (p.v + p.half_height > 0.0f) & (p.v - p.half_height < float(camera.height));
}

/// Behind set_colour.
[[gnu::always_inline]] inline void set_plane(const TrainingCamera& camera, Projections& p) {
  const Lanes3& normal = p.axes[2];
  set_dot(normal, p.at, p.plane);
  const Lanes least = kLeastCosine * p.distance;
  p.grazing = (p.plane < 0.0f ? -p.plane : p.plane) < least;
  p.plane = p.grazing ? (p.plane < 0.0f ? -least : least) : p.plane;
  p.near = camera.depth / p.at[2];
  p.near_du = camera.depth * normal[0] / (camera.fx * p.plane);
  p.near_dv = camera.depth * normal[1] / (camera.fy * p.plane);
}

[[gnu::always_inline]] inline void set_colour(const TrainingCamera& camera, Projections& p) {
  Lanes3 away;
  for (std::size_t a = 0; a < 3; ++a) away[a] = p.value[a] - camera.centre[a];
  Lanes square;
  set_dot(away, away, square);
  set_root(square, p.distance);
  for (std::size_t a = 0; a < 3; ++a) p.direction[a] = away[a] / p.distance;
  TrainedFunctions<Lanes> functions;
  set_functions(p.direction, functions);
  for (std::size_t c = 0; c < 3; ++c) {
    Lanes sum = Lanes{} + 0.5f;
    for (std::size_t k = 0; k < kTrainedFunctions; ++k)
      sum += functions[k] * p.value[TrainedSurfel::kColour + 3 * k + c];
    p.colour[c] = sum < 0.0f ? Lanes{} : sum;
  }
}

}  // namespace slf
