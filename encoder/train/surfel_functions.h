// SPDX-License-Identifier: Apache-2.0
// What a surfel's turn and its harmonics mean, for one surfel or for eight at a time: T is float or
// Lanes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>

#include "lightfield/render/lanes.h"

namespace slf {

/// Harmonics to degree 3, in the order and with the signs of 3DGS.
inline constexpr std::size_t kTrainedFunctions = 16;
inline constexpr float kMeanFunction = 0.28209479177387814f;  ///< the first, a constant

// Kerbl et al., "3D Gaussian Splatting" (2023), as their files have it.
inline constexpr float kLinearScale = 0.4886025119029199f;
inline constexpr float kProductScale = 1.0925484305920792f;  // of two coordinates
inline constexpr float kZonalScale = 0.31539156525252005f, kSectoralScale = 0.5462742152960396f;
// Degree 3: of orders 3, 2, 1 and 0, and of z (x^2 - y^2).
inline constexpr float kThird0 = 0.5900435899266435f, kThird1 = 2.890611442640554f,
                       kThird2 = 0.4570457994644658f, kThird3 = 0.3731763325901154f,
                       kThird4 = 1.445305721320277f;

template <class T>
using Three = std::array<T, 3>;
template <class T>
using TrainedFunctions = std::array<T, kTrainedFunctions>;

inline void set_root(const float& square, float& root) { root = std::sqrt(square); }

/// A quaternion of length 1, and one over the length that it had.
template <class T>
struct UnitTurn {
  T w, x, y, z, inverse;
};

/// @param q  w, x, y, z of any length
template <class T>
[[gnu::always_inline]] inline void set_unit_turn(const T* q, UnitTurn<T>& turn) {
  const T square = q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3];
  T length;
  set_root(square < 1e-20f ? T{} + 1e-20f : square, length);
  turn.inverse = 1 / length;
  turn.w = q[0] * turn.inverse;
  turn.x = q[1] * turn.inverse;
  turn.y = q[2] * turn.inverse;
  turn.z = q[3] * turn.inverse;
}

/// Columns of the rotation.
template <class T>
[[gnu::always_inline]] inline void set_axes(const UnitTurn<T>& turn, Three<Three<T>>& axes) {
  const auto& [w, x, y, z, inverse] = turn;
  axes = {{{1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
           {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
           {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)}}};
}

/// @param by_axes  gradient by the columns
/// @param by_turn  w, x, y, z: what it is by the quaternion is added
template <class T>
[[gnu::always_inline]] inline void add_turn_gradient(const UnitTurn<T>& turn,
                                                     const Three<Three<T>>& by_axes, T* by_turn) {
  const auto& [w, x, y, z, inverse] = turn;
  const auto& [a, b, n] = by_axes;
  const std::array<T, 4> unit = {
      2 * (z * a[1] - y * a[2] - z * b[0] + x * b[2] + y * n[0] - x * n[1]),
      2 * (y * a[1] + z * a[2] + y * b[0] - 2 * x * b[1] + w * b[2] + z * n[0] - w * n[1] -
           2 * x * n[2]),
      2 * (-2 * y * a[0] + x * a[1] - w * a[2] + x * b[0] + z * b[2] + w * n[0] + z * n[1] -
           2 * y * n[2]),
      2 * (-2 * z * a[0] + w * a[1] + x * a[2] - w * b[0] - 2 * z * b[1] + y * b[2] + x * n[0] +
           y * n[1])};
  const std::array<T, 4> q = {w, x, y, z};
  T along{};
  for (std::size_t i = 0; i < 4; ++i) along += q[i] * unit[i];
  for (std::size_t i = 0; i < 4; ++i) by_turn[i] += inverse * (unit[i] - along * q[i]);
}

/// Values of the harmonics for a unit direction, from the camera to the surfel.
template <class T>
[[gnu::always_inline]] inline void set_functions(const Three<T>& direction,
                                                 TrainedFunctions<T>& functions) {
  const auto& [x, y, z] = direction;
  functions = {T{} + kMeanFunction,
               -kLinearScale * y,
               kLinearScale * z,
               -kLinearScale * x,
               kProductScale * x * y,
               -kProductScale * y * z,
               kZonalScale * (2 * z * z - x * x - y * y),
               -kProductScale * x * z,
               kSectoralScale * (x * x - y * y),
               -kThird0 * y * (3 * x * x - y * y),
               kThird1 * x * y * z,
               -kThird2 * y * (4 * z * z - x * x - y * y),
               kThird3 * z * (2 * z * z - 3 * x * x - 3 * y * y),
               -kThird2 * x * (4 * z * z - x * x - y * y),
               kThird4 * z * (x * x - y * y),
               -kThird0 * x * (x * x - 3 * y * y)};
}

/// What a change of each value means for the direction.
/// @param g  gradient by the values
template <class T>
[[gnu::always_inline]] inline void set_direction_gradient(const Three<T>& direction,
                                                          const TrainedFunctions<T>& g,
                                                          Three<T>& gradient) {
  const auto& [x, y, z] = direction;
  gradient = {
      -kLinearScale * g[3] + kProductScale * (y * g[4] - z * g[7]) - 2 * kZonalScale * x * g[6] +
          2 * kSectoralScale * x * g[8] -
          kThird0 * (6 * x * y * g[9] + 3 * (x * x - y * y) * g[15]) + kThird1 * y * z * g[10] +
          kThird2 * (2 * x * y * g[11] - (4 * z * z - 3 * x * x - y * y) * g[13]) -
          6 * kThird3 * x * z * g[12] + 2 * kThird4 * x * z * g[14],
      -kLinearScale * g[1] + kProductScale * (x * g[4] - z * g[5]) - 2 * kZonalScale * y * g[6] -
          2 * kSectoralScale * y * g[8] -
          kThird0 * (3 * (x * x - y * y) * g[9] - 6 * x * y * g[15]) + kThird1 * x * z * g[10] -
          kThird2 * ((4 * z * z - x * x - 3 * y * y) * g[11] - 2 * x * y * g[13]) -
          6 * kThird3 * y * z * g[12] - 2 * kThird4 * y * z * g[14],
      kLinearScale * g[2] - kProductScale * (y * g[5] + x * g[7]) + 4 * kZonalScale * z * g[6] +
          kThird1 * x * y * g[10] - 8 * kThird2 * z * (y * g[11] + x * g[13]) +
          3 * kThird3 * (2 * z * z - x * x - y * y) * g[12] + kThird4 * (x * x - y * y) * g[14]};
}

}  // namespace slf
