// SPDX-License-Identifier: Apache-2.0
// LAS, the format of laser scanners, as it is without compression. Of LAZ, its compressed form, the
// header alone is looked at.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "capture/read_scan.h"

namespace slf {

/// Whether the file is LAS 1.0 to 1.4 and its points are not compressed.
bool is_plain_las(const std::filesystem::path& file);

/// Its points: coordinates with all their digits, colours where its format has them, a coordinate
/// system that is written as WKT. Colours of 16 bits that are all below 256 are taken for 8 bits.
/// @param warnings  or null
/// @errors kUnreadable; kInvalidInput: names the element of the header
Result<Scan, InputError> read_las(const std::filesystem::path& file,
                                  std::vector<std::string>* warnings);

}  // namespace slf
