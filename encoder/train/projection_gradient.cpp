// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/surfel_projection.h"

#include <algorithm>
#include <cstdint>

#include "base/multiversion.h"
#include "encoder/train/projection_lanes.h"

namespace slf {
namespace {

/// What the loss says of eight projected surfels.
struct GradientLanes {
  Lanes3 colour;
  Lanes opacity, a, b, c, u, v, near, near_du, near_dv, drawn, pull;
};
static_assert(sizeof(GradientLanes) == sizeof(ProjectedGradient) * kLaneCount);

/// @param direction  receives the gradient by it
[[gnu::always_inline]] inline void set_colour_gradient(const Projections& p, const Lanes3& gradient,
                                                       SurfelColumns& sum, Lanes3& direction) {
  TrainedFunctions<Lanes> functions, weights{};
  set_functions(p.direction, functions);
  for (std::size_t c = 0; c < 3; ++c) {
    const Lanes by_colour = p.colour[c] > 0.0f ? gradient[c] : Lanes{};
    for (std::size_t k = 0; k < kTrainedFunctions; ++k) {
      const std::size_t at = TrainedSurfel::kColour + 3 * k + c;
      sum[at] = functions[k] * by_colour;
      weights[k] += p.value[at] * by_colour;
    }
  }
  set_direction_gradient(p.direction, weights, direction);
}

/// By the radii in pixels, from that by the ellipse: dQ = -C dC C, dA = 2 dQ A.
[[gnu::always_inline]] inline void set_across_gradient(
    const Projections& p, const GradientLanes& g, std::array<std::array<Lanes, 2>, 3>& gradient) {
  const Lanes &a = p.a, &b = p.b, &c = p.c, h = g.b / 2;
  const Lanes r0 = g.a * a + h * b, r1 = g.a * b + h * c;  // rows of dC C
  const Lanes s0 = h * a + g.c * b, s1 = h * b + g.c * c;
  const Lanes uu = -(a * r0 + b * s0), uv = -(a * r1 + b * s1), vv = -(b * r1 + c * s1);
  for (std::size_t k = 0; k < gradient.size(); ++k) {
    gradient[k][0] = 2 * (uu * p.across[k][0] + uv * p.across[k][1]);
    gradient[k][1] = 2 * (uv * p.across[k][0] + vv * p.across[k][1]);
  }
}

/// Through A, of which row k is radius_k J R axis_k.
/// @param axes  world: receives the gradient by them
/// @param at  receives that by the place in the camera
[[gnu::always_inline]] inline void set_shape_gradient(const TrainingCamera& camera,
                                                      const Projections& p, const GradientLanes& g,
                                                      SurfelColumns& sum, Three<Lanes3>& axes,
                                                      Lanes3& at) {
  std::array<std::array<Lanes, 2>, 3> across;
  set_across_gradient(p, g, across);
  const Lanes& z = p.at[2];
  at = {};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const Lanes3& axis = p.axes[k];
    const Lanes u = across[k][0] * p.radius[k], v = across[k][1] * p.radius[k];
    const Lanes3 in_camera = {u * p.scale[0][0], v * p.scale[1][0],
                              u * p.scale[0][1] + v * p.scale[1][1]};
    set_turned_back(camera.rotation, in_camera, axes[k]);
    set_dot(in_camera, axis, sum[TrainedSurfel::kLogRadius + k]);
    // The Jacobian's entries are f / z and -f s / z, and s is x / z unless it was clamped.
    for (std::size_t i = 0; i < 2; ++i) {
      const Lanes d = (i == 0 ? u : v) * (i == 0 ? camera.fx : camera.fy) / (z * z);
      const Lanes by_slope = d * axis[2];
      at[i] -= p.clamped[i] ? Lanes{} : by_slope;
      const Lanes times = p.clamped[i] ? Lanes{} + 1.0f : Lanes{} + 2.0f;
      at[2] += d * (times * p.slope[i] * axis[2] - axis[i]);
    }
  }
}

/// Through (u, v), and the inverse depth of the plane.
/// @param normal  in the camera: receives the gradient by it
[[gnu::always_inline]] inline void add_place_gradient(const TrainingCamera& camera,
                                                      const Projections& p, const GradientLanes& g,
                                                      Lanes3& normal, Lanes3& at) {
  const auto& [x, y, z] = p.at;
  at[0] += g.u * camera.fx / z;
  at[1] += g.v * camera.fy / z;
  at[2] -= (g.u * camera.fx * x + g.v * camera.fy * y) / (z * z);
  at[2] -= g.near * camera.depth / (z * z);
  const Lanes fu = camera.depth / (camera.fx * p.plane), fv = camera.depth / (camera.fy * p.plane);
  const Lanes slope = -(g.near_du * fu * p.axes[2][0] + g.near_dv * fv * p.axes[2][1]) / p.plane;
  const Lanes plane = p.grazing ? Lanes{} : slope;
  normal = {g.near_du * fu, g.near_dv * fv, Lanes{}};
  for (std::size_t a = 0; a < 3; ++a) {
    normal[a] += plane * p.at[a];
    at[a] += plane * p.axes[2][a];
  }
}

[[gnu::always_inline]] inline void set_surfel_gradient(const TrainingCamera& camera,
                                                       const Projections& p, const GradientLanes& g,
                                                       SurfelColumns& sum) {
  Lanes3 direction, at, normal, turned;
  set_colour_gradient(p, g.colour, sum, direction);
  sum[TrainedSurfel::kOpacity] = g.opacity * p.opacity * (1 - p.opacity);
  Three<Lanes3> axes;
  set_shape_gradient(camera, p, g, sum, axes, at);
  add_place_gradient(camera, p, g, normal, at);
  set_turned_back(camera.rotation, normal, turned);
  for (std::size_t a = 0; a < 3; ++a) axes[2][a] += turned[a];
  for (std::size_t k = 0; k < 4; ++k) sum[TrainedSurfel::kTurn + k] = Lanes{};
  add_turn_gradient(p.turn, axes, &sum[TrainedSurfel::kTurn]);
  Lanes3 position;
  set_turned_back(camera.rotation, at, position);
  // The direction is that of length 1.
  Lanes along;
  set_dot(direction, p.direction, along);
  for (std::size_t a = 0; a < 3; ++a)
    sum[TrainedSurfel::kPosition + a] =
        position[a] + 1 / p.distance * (direction[a] + -along * p.direction[a]);
}

SLF_MULTIVERSION_LANES void set_gradients(
    const TrainedSurfel* surfels, const TrainingCamera& camera, const ProjectedSurfel* projected,
    const ProjectedGradient* gradients, std::span<const std::uint32_t> which, TrainedSurfel* sums) {
  for (std::size_t i = 0; i < which.size(); i += kLaneCount) {
    const std::size_t some = std::min(kLaneCount, which.size() - i);
    SurfelRows rows, by_rows;
    std::array<float*, kLaneCount> to;
    for (std::size_t k = 0; k < kLaneCount; ++k) {
      const std::uint32_t at = which[i + std::min(k, some - 1)];
      rows[k] = surfels[projected[at].surfel].value.data();
      by_rows[k] = reinterpret_cast<const float*>(&gradients[at]);
      to[k] = sums[projected[at].surfel].value.data();
    }
    std::array<Lanes, sizeof(ProjectedGradient) / sizeof(float)> columns;
    load_rows(by_rows, columns);
    GradientLanes g;
    std::memcpy(&g, &columns, sizeof g);
    Projections p;
    set_centres(rows, camera, p);
    set_ellipse(camera, p);
    set_colour(camera, p);
    set_plane(camera, p);
    SurfelColumns sum;
    set_surfel_gradient(camera, p, g, sum);
    store_rows(sum, to, some);
  }
}

}  // namespace

void set_trained_gradients(std::span<const TrainedSurfel> surfels, const TrainingCamera& camera,
                           std::span<const ProjectedSurfel> projected,
                           std::span<const ProjectedGradient> gradients,
                           std::span<const std::uint32_t> which, std::span<TrainedSurfel> sums) {
  set_gradients(surfels.data(), camera, projected.data(), gradients.data(), which, sums.data());
}

}  // namespace slf
