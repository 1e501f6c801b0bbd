// SPDX-License-Identifier: Apache-2.0
// E57, the exchange format of laser scanners: all clouds of a file in its common world.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/read_scan.h"

namespace slf {

/// Points that were measured, cartesian or spherical, moved by their clouds' poses; colours and
/// normals where every cloud has them, and the file's coordinate system where it is WKT. Pictures,
/// intensities and times are left out. A file takes its size in memory beside the points.
/// @param warnings  or null
/// @errors those of E57File; kInvalidInput: names the cloud and the element
Result<Scan, InputError> read_e57(const std::filesystem::path& file,
                                  std::vector<std::string>* warnings);

}  // namespace slf
