// SPDX-License-Identifier: Apache-2.0
// A light field in forms that other programs read.
#pragma once

#include <string>

#include "slf/capture.h"
#include "slf/types.h"
#include "tools/failure.h"

namespace slf::tools {

/// World positions, normals where coded, and the mean colour (display values) where there is a
/// basis.
PointCloud mean_cloud(const LightField& field, int threads);

/// Floats, from a double's origin, hold the world coordinates of every voxel. A grid may lie
/// anywhere that a double reaches.
Outcome require_cloud_grid(const LightField& field, const std::string& file);

/// Writes positions.npy, components.npy, octahedral.npy where normals are coded, light_field.json:
/// all of them or none (save_directory).
Outcome dump(const LightField& field, bool planes, const std::string& directory);

}  // namespace slf::tools
