// SPDX-License-Identifier: Apache-2.0
// Scanners' own formats: LAS and E57 by readers of ours, LAZ by PDAL. The adapter of its program.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

struct Scan {
  Mesh points;      ///< without faces
  std::string crs;  ///< as WKT, where the file has one
};

/// Is it LAS, LAZ or E57, by its name?
bool is_scan(const std::filesystem::path& file);

/// LAS by read_las, E57 by read_e57. LAZ is what `pdal` reads of it: it makes a PLY of it, in a
/// temporary file of some 40 bytes a point. Coordinates stay doubles. Colours of 16 bits that are
/// all below 256 are taken for 8 bits.
/// @errors kUnreadable; kUnsupported: no PDAL on this machine; kInvalidInput: PDAL refuses it,
/// those
///         of a PLY
Result<Scan, InputError> read_scan(const std::filesystem::path& file,
                                   std::vector<std::string>* warnings);

}  // namespace slf
