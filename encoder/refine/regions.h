// SPDX-License-Identifier: Apache-2.0
// Where mending helped, and where the capture's points are better.
#pragma once

#include <cstdint>
#include <vector>

#include "encoder/refine/held_out.h"

namespace slf {

/// [P of before] 1: held-out photographs are predicted worse after than before around this point.
/// Decided for cubes of `side` with their neighbours; points after count where they come from.
/// @param uncovered  [P of before] what counts as predicted so after in place of missing points
std::vector<std::uint8_t> worse_after(const SurfacePoints& before,
                                      const HeldOutErrors& errors_before,
                                      const SurfacePoints& after, const HeldOutErrors& errors_after,
                                      const HeldOutErrors& uncovered, double side);

/// `after`, but with the points of `before` that are marked in place of what came of them.
SurfacePoints with_kept(const SurfacePoints& before, const SurfacePoints& after,
                        const std::vector<std::uint8_t>& marked);

/// Without the points that were moved by more than `move` and that no camera sees: folds inside of
/// the object, which nothing supports. Points that stayed (a base that stood on a table) remain.
SurfacePoints without_unsupported(const SurfacePoints& before, const SurfacePoints& after,
                                  const std::vector<std::uint8_t>& seen, double move);

}  // namespace slf
