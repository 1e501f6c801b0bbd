// SPDX-License-Identifier: Apache-2.0
// Points that were exported in another world than that of the cameras: other axes, units, origin.
#pragma once

#include <array>
#include <string>

#include "slf/error.h"
#include "slf/types.h"

namespace slf {

/// What brings points into the world of the cameras: axes first, then the scale, then the shift.
struct WorldChange {
  /// [new axis] the old axis that it is: 1, 2, 3 for x, y, z, negative where it is turned round.
  std::array<int, 3> axes{1, 2, 3};
  double scale = 1;
  Vec3 shift{0, 0, 0};

  Vec3 apply(const Vec3& at) const;
  bool mirrors() const;
};

/// "x,-z,y", with a scale and a shift where they are not 1 and 0: "x,y,z,0.001,0,0,2".
std::string text_of(const WorldChange& change);
/// @errors kInvalidArgument: something else than text_of() writes; an axis twice; a scale that is
///         not positive
Result<WorldChange, InputError> parse_world_change(const std::string& text);

}  // namespace slf
