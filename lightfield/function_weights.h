// SPDX-License-Identifier: Apache-2.0
// A light field as weights and functions of direction: what a renderer elsewhere is handed.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "lightfield/component_colours.h"
#include "lightfield/function_table.h"
#include "slf/types.h"

namespace slf {

/// Radiance is the sum over W functions of weight times function, before the clamp. Unlike ViewMaps
/// it keeps no copy of the weights. Thread-safe.
class FunctionWeights {
 public:
  /// Keeps a reference. The light field must have a basis. O(K R); with a joint transform (6.7)
  /// O(P K R), and W is then K.
  FunctionWeights(const LightField& light_field, int threads);

  /// W
  std::size_t size() const { return table_.size(); }
  /// [W][3] R, G, B of point p.
  void weights(std::size_t p, float* rgb) const;

  /// Floats that functions() needs to hold: W and some more.
  std::size_t stride() const { return table_.stride(); }
  /// The W functions along a direction of any length > 0 local to the points, gamma clamped
  /// to the header's range.
  void functions(const Vec3& direction, float* row) const;

 private:
  LightFieldHeader header_;           // without joint transforms
  std::vector<std::int32_t> planes_;  // given planes of a joint transform, or none
  std::span<const std::int32_t> components_;
  ComponentColours colours_;
  FunctionTable table_;
};

/// Direction through a place on a face of a cube, OpenGL's order and axes: +x -x +y -y +z -z.
/// @param s, t  -1 .. 1
Vec3 cube_direction(std::size_t face, double s, double t);

}  // namespace slf
