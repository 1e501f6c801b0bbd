// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/surfel_projection.h"

#include <algorithm>
#include <cmath>

#include "encoder/train/tile_pixels.h"
#include "lightfield/render/reference_kernel.h"

namespace slf {
namespace {

constexpr auto kFilterSquare =
    float(kReferenceKernel.filter_pixels * kReferenceKernel.filter_pixels);
constexpr float kGaussianFilter = GaussianKernel::filter * kGaussianReach;  // in squared radii
constexpr float kNearest = 0.02f;      // of the camera's depth: nearer, a disc is no ellipse
constexpr float kLeastCosine = 0.15f;  // a flatter plane's depth says nothing
constexpr float kLeastOpacity = 1.0f / 255;
constexpr float kMostSlope = 1.3f;  // times the picture: beyond, the picture is not linear at all

float axis_dot(const std::array<Float3, 3>& rotation, std::size_t row, const Float3& v) {
  return dot(rotation[row], v);
}

Float3 turned(const std::array<Float3, 3>& rotation, const Float3& v) {
  return {axis_dot(rotation, 0, v), axis_dot(rotation, 1, v), axis_dot(rotation, 2, v)};
}

/// R^T v
Float3 turned_back(const std::array<Float3, 3>& rotation, const Float3& v) {
  Float3 out{};
  for (std::size_t r = 0; r < 3; ++r) out = along(out, v[r], rotation[r]);
  return out;
}

/// What the picture's derivatives take for x / z: clamped far outside of the picture.
float slope(float at, float focal, float principal, int size) {
  const float low = -kMostSlope * principal / focal;
  const float high = kMostSlope * (float(size) - principal) / focal;
  return std::clamp(at, std::min(low, 0.0f), std::max(high, 0.0f));
}

/// Squared radii at which alpha is 1/255, where GaussianRenderer ends it: 0 .. 1
/// @param opacity  more than that
float gaussian_reach(float opacity) {
  return std::clamp(1 + 2 * std::log(opacity) / kGaussianReach, 0.0f, 1.0f);
}

bool set_ellipse(float filter_square, SurfelProjection& p) {
  float uu = filter_square, uv = 0, vv = filter_square;
  for (const auto& axis : p.across) {
    uu += axis[0] * axis[0];
    uv += axis[0] * axis[1];
    vv += axis[1] * axis[1];
  }
  const float determinant = uu * vv - uv * uv;
  if (!(determinant > 0) || !std::isfinite(determinant)) return false;
  p.projected.a = vv / determinant;
  p.projected.b = -uv / determinant;
  p.projected.c = uu / determinant;
  p.projected.half_width = std::sqrt(uu * p.projected.reach);
  p.projected.half_height = std::sqrt(vv * p.projected.reach);
  return true;
}

void set_plane(const TrainingCamera& camera, SurfelProjection& p) {
  p.normal = turned(camera.rotation, p.axes.normal);
  p.plane = dot(p.normal, p.at);
  const float least = kLeastCosine * p.distance;
  p.grazing = std::abs(p.plane) < least;
  if (p.grazing) p.plane = p.plane < 0 ? -least : least;
  p.projected.near = camera.depth / p.at[2];
  p.projected.near_du = camera.depth * p.normal[0] / (camera.fx * p.plane);
  p.projected.near_dv = camera.depth * p.normal[1] / (camera.fy * p.plane);
}

void set_colour(const TrainedSurfel& surfel, SurfelProjection& p) {
  const auto functions = trained_functions(p.direction);
  for (std::size_t c = 0; c < 3; ++c) {
    float sum = 0.5f;
    for (std::size_t k = 0; k < kTrainedFunctions; ++k)
      sum += functions[k] * surfel.value[TrainedSurfel::kColour + 3 * k + c];
    p.projected.colour[c] = std::max(sum, 0.0f);
  }
}

/// @param direction  receives the gradient by it
void add_colour_gradient(const TrainedSurfel& surfel, const SurfelProjection& p,
                         const Float3& gradient, TrainedSurfel& sum, Float3& direction) {
  const auto functions = trained_functions(p.direction);
  std::array<float, kTrainedFunctions> weights{};
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(p.projected.colour[c] > 0)) continue;
    for (std::size_t k = 0; k < kTrainedFunctions; ++k) {
      const std::size_t at = TrainedSurfel::kColour + 3 * k + c;
      sum.value[at] += functions[k] * gradient[c];
      weights[k] += surfel.value[at] * gradient[c];
    }
  }
  direction = direction_gradient(p.direction, weights);
}

/// By the radii in pixels, from that by the ellipse: dQ = -C dC C, dA = 2 dQ A.
std::array<std::array<float, 2>, 3> across_gradient(const SurfelProjection& p,
                                                    const ProjectedGradient& g) {
  const auto& [a, b, c] = std::array{p.projected.a, p.projected.b, p.projected.c};
  const float h = g.b / 2;
  const float r0 = g.a * a + h * b, r1 = g.a * b + h * c;  // rows of dC C
  const float s0 = h * a + g.c * b, s1 = h * b + g.c * c;
  const float uu = -(a * r0 + b * s0), uv = -(a * r1 + b * s1), vv = -(b * r1 + c * s1);
  std::array<std::array<float, 2>, 3> out{};
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k][0] = 2 * (uu * p.across[k][0] + uv * p.across[k][1]);
    out[k][1] = 2 * (uv * p.across[k][0] + vv * p.across[k][1]);
  }
  return out;
}

}  // namespace

std::optional<SurfelProjection> project_surfel(const TrainedSurfel& surfel,
                                               const TrainingCamera& camera) {
  SurfelProjection p;
  p.at = camera.in_camera(surfel.position());
  const auto [x, y, z] = p.at;
  if (!(z > kNearest * camera.depth)) return {};
  p.projected.opacity = surfel.opacity();
  if (!(p.projected.opacity > kLeastOpacity)) return {};
  p.projected.u = camera.fx * x / z + camera.cx;
  p.projected.v = camera.fy * y / z + camera.cy;
  p.axes = axes_of(surfel);
  p.radius = {surfel.radius(0), surfel.radius(1), camera.gaussian ? surfel.radius(2) : 0};
  p.slope = {slope(x / z, camera.fx, camera.cx, camera.width),
             slope(y / z, camera.fy, camera.cy, camera.height)};
  p.clamped = {p.slope[0] != x / z, p.slope[1] != y / z};
  p.jacobian = {Float3{camera.fx / z, 0, -camera.fx * p.slope[0] / z},
                Float3{0, camera.fy / z, -camera.fy * p.slope[1] / z}};
  for (std::size_t k = 0; k < p.across.size(); ++k) {
    const Float3 axis = turned(camera.rotation, p.axes.axis(k));
    for (std::size_t i = 0; i < 2; ++i) p.across[k][i] = p.radius[k] * dot(p.jacobian[i], axis);
  }
  if (camera.gaussian) p.projected.reach = gaussian_reach(p.projected.opacity);
  if (!set_ellipse(camera.gaussian ? kGaussianFilter : kFilterSquare, p)) return {};
  const ProjectedSurfel& s = p.projected;
  if (!(s.u + s.half_width > 0 && s.u - s.half_width < float(camera.width) &&
        s.v + s.half_height > 0 && s.v - s.half_height < float(camera.height)))
    return {};
  const Float3 away = minus(surfel.position(), camera.centre);
  p.distance = std::sqrt(dot(away, away));
  p.direction = {away[0] / p.distance, away[1] / p.distance, away[2] / p.distance};
  set_plane(camera, p);
  set_colour(surfel, p);
  return p;
}

void add_projection_gradient(const TrainedSurfel& surfel, const TrainingCamera& camera,
                             const SurfelProjection& p, const ProjectedGradient& g,
                             TrainedSurfel& sum) {
  const auto [x, y, z] = p.at;
  Float3 direction;
  add_colour_gradient(surfel, p, g.colour, sum, direction);
  const float o = p.projected.opacity;
  sum.value[TrainedSurfel::kOpacity] += g.opacity * o * (1 - o);
  const auto across = across_gradient(p, g);
  // across[k] = radius_k J R axis_k
  Float3 at{};
  std::array<Float3, 3> axes{};
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const Float3 axis = turned(camera.rotation, p.axes.axis(k));
    Float3 in_camera{};
    for (std::size_t i = 0; i < 2; ++i)
      in_camera = along(in_camera, across[k][i] * p.radius[k], p.jacobian[i]);
    axes[k] = turned_back(camera.rotation, in_camera);
    sum.value[TrainedSurfel::kLogRadius + k] += dot(in_camera, axis);
    // The Jacobian's entries are f / z and -f s / z, and s is x / z unless it was clamped.
    for (std::size_t i = 0; i < 2; ++i) {
      const float d = across[k][i] * p.radius[k] * (i == 0 ? camera.fx : camera.fy) / (z * z);
      if (!p.clamped[i]) at[i] -= d * axis[2];
      at[2] += d * ((p.clamped[i] ? 1.0f : 2.0f) * p.slope[i] * axis[2] - axis[i]);
    }
  }
  // (u, v), and the inverse depth of the plane.
  at[0] += g.u * camera.fx / z;
  at[1] += g.v * camera.fy / z;
  at[2] -= (g.u * camera.fx * x + g.v * camera.fy * y) / (z * z);
  at[2] -= g.near * camera.depth / (z * z);
  const float fu = camera.depth / (camera.fx * p.plane), fv = camera.depth / (camera.fy * p.plane);
  Float3 normal{g.near_du * fu, g.near_dv * fv, 0};
  if (!p.grazing) {
    const float plane = -(g.near_du * fu * p.normal[0] + g.near_dv * fv * p.normal[1]) / p.plane;
    normal = along(normal, plane, p.at);
    at = along(at, plane, p.normal);
  }
  add_turn_gradient(surfel,
                    {axes[0], axes[1], along(axes[2], 1, turned_back(camera.rotation, normal))},
                    &sum.value[TrainedSurfel::kTurn]);
  Float3 position = turned_back(camera.rotation, at);
  // The direction is that of length 1.
  position =
      along(position, 1 / p.distance, along(direction, -dot(direction, p.direction), p.direction));
  for (std::size_t a = 0; a < 3; ++a) sum.value[TrainedSurfel::kPosition + a] += position[a];
}

}  // namespace slf
