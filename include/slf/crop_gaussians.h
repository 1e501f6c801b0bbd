// SPDX-License-Identifier: Apache-2.0
// The splats of a file that are wanted, in the world that they are wanted in, and those that are
// far away from all others.
#pragma once

#include <string>

#include "slf/capture.h"
#include "slf/gaussians.h"
#include "slf/points_world.h"

namespace slf {

/// Keeps the splats whose centres are in a box of the file's axes, in their order.
/// @errors kInvalidInput: nothing is in the box. O(P K)
Result<Done, InputError> crop(Gaussians& splats, const WorldBox& box);

/// Brings splats into another world; `up` stays. O(P K)
void change_world(const WorldChange& change, Gaussians& splats);

/// What to say of splats of which a few are so far away that the finest grid is too coarse for all
/// others: a box for crop(). Empty of any other file. O(P)
std::string far_splats_warning(const Gaussians& splats);

}  // namespace slf
