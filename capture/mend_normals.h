// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "slf/capture.h"

namespace slf {

/// Normals of length 0, or not finite. Those of a cloud become the mean of their nearest
/// neighbours' that have one. All are left out where half of them have none, and of a mesh, whose
/// faces know better. The others become unit vectors.
/// @return how many there were
/// The same on every run. O(P log P) where there are any.
std::size_t mend_normals(Mesh& mesh);

}  // namespace slf
