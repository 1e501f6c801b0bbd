// SPDX-License-Identifier: Apache-2.0
// Convex solids that a large scene is built of, each given by the box around it.
#pragma once

#include <cstdint>
#include <optional>

#include "tools/synth/vec.h"

namespace slf::synth {

enum class Shape : std::uint8_t {
  kBox,
  kSphere,    ///< the box is a cube
  kCylinder,  ///< upright; the box has a square base
  kRoof,      ///< a prism of triangles, its ridge along x
};

/// What a solid is made of: terrace_finish.h says how that looks.
enum class Surface : std::uint8_t {
  kBrick,
  kPlaster,
  kTrim,  ///< dressed stone
  kWindow,
  kDoor,
  kTilesOnBrick,    ///< of a roof, and what its gables are of
  kTilesOnPlaster,  ///< the same
  kGravel,
  kSetts,  ///< of the road
  kPaving,
  kGrass,
  kBrass,
  kChrome,
  kIron,
  kPottery,
  kLeaves,
  kBark,
  kMarble,
  kLampGlass,
};

struct Solid {
  Vec3 low, high;
  Shape shape = Shape::kBox;
  Surface surface = Surface::kTrim;
  std::uint32_t seed = 0;  ///< of its colours and patterns
};

/// A ray with what tests of boxes want to know of it.
struct Probe {
  explicit Probe(const Ray& ray)
      : origin(ray.origin),
        direction(ray.direction),
        inverse{1 / ray.direction[0], 1 / ray.direction[1], 1 / ray.direction[2]} {}
  Vec3 origin, direction, inverse;
};

/// Where a line runs inside of a convex solid: parameters and outward normals of its two ends.
struct Chord {
  double enter, leave;
  Vec3 enter_normal, leave_normal;
};

/// Faces belong to a box on its lower sides, not on its upper ones, so that of two boxes that touch
/// one has what a line along both of them meets.
std::optional<Chord> chord(const Solid& solid, const Probe& line);

/// Is the point inside?
bool contains(const Solid& solid, const Vec3& point);

}  // namespace slf::synth
