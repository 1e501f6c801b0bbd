// SPDX-License-Identifier: Apache-2.0
// Whether points are in the world of their photographs: exporters turn axes, and take other units.
#pragma once

#include <optional>
#include <span>
#include <string>

#include "slf/capture.h"
#include "slf/points_world.h"

namespace slf {

/// Points that photographs do not agree with.
struct OtherWorld {
  std::optional<WorldChange> change;  ///< that makes them agree; of a few digits
  double given = 0, changed = 0;      ///< agreement, 0 .. 1
  std::string warning() const;        ///< one line, for the person to read
};

/// Looks at a dozen photographs and a sample of the points. If they agree badly, the 48 ways to
/// exchange and turn axes are tried, with usual scales, and with those and the shifts that bring
/// the points to where outlines of the object are. Agreement: the colours of a point in all
/// photographs that see it, and outlines by masks, alpha or a background of one colour.
/// @param points  world; a few hundred at least, else there is no answer
/// @return nothing: they agree, or there is no telling
/// The same for any thread count.
std::optional<OtherWorld> other_world(std::span<const Vec3> points, const Capture& capture,
                                      int threads = 0);

}  // namespace slf
