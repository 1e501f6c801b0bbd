// SPDX-License-Identifier: Apache-2.0
// Lenses with more radial terms than a Camera has.
#pragma once

#include <array>
#include <optional>
#include <string>

#include "slf/capture.h"

namespace slf {

/// k1, k2, ...: r (1 + k1 r^2 + k2 r^4 + k3 r^6 + k4 r^8), undistorted to distorted.
using RadialTerms = std::array<double, 4>;

/// Sets k1 and k2 of the camera, whose size, focal length and principal point are known. Where k3
/// or k4 is not 0, k1 and k2 are those that come nearest within the picture.
/// @return how far they miss, in pixels; nothing where terms are not finite, or the lens folds
///         before the corners
std::optional<double> set_radial(const RadialTerms& terms, Camera& camera);

/// set_radial, with its miss reported.
/// @param label  for messages
/// @param worst  receives the largest miss of several calls
/// @errors kInvalidInput: more than a pixel, and than a 2000th of the longer side
Result<Done, InputError> set_radial(const RadialTerms& terms, const std::string& label,
                                    Camera& camera, double& worst);

/// A warning of misses that are seen; empty below a tenth of a pixel.
std::string radial_warning(const std::string& file, double worst);

}  // namespace slf
