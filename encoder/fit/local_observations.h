// SPDX-License-Identifier: Apache-2.0
// Observations along the local directions of their points. Spec 6.4.
#pragma once

#include <array>
#include <span>

#include "slf/fit.h"

namespace slf {

/// gamma_min and gamma_max of the directions that are there.
void set_gamma_range(Observations& observations);

/// The observations with their directions mirrored at these normals, gamma range too.
Observations in_local(Observations observations, std::span<const std::array<float, 3>> normals,
                      int threads);

}  // namespace slf
