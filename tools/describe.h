// SPDX-License-Identifier: Apache-2.0
// Headers and reports as JSON and as text.
#pragma once

#include <string>

#include <nlohmann/json.hpp>

#include "slf/capture.h"
#include "slf/decoder.h"
#include "slf/surface.h"

namespace slf::tools {

nlohmann::ordered_json header_json(const LightFieldHeader& header);
std::string header_text(const LightFieldHeader& header);

/// A list, since keys may repeat: [{"key": ..., "value": ...}].
nlohmann::ordered_json metadata_json(const Metadata& metadata);

/// How a file was made: its headers' and its metadata's settings in one object.
nlohmann::ordered_json settings_json(const StreamInfo& info);

/// Bytes of the whole file by unit type; "signature" is what no unit holds.
/// The chosen grid, and what it is to the photographs. Keys: bits, voxel_size, limited_by_cloud;
/// pixel_size, voxel_pixels and cloud_spacing where they are known.
nlohmann::ordered_json density_json(const Grid& grid, const Density& density);
std::string density_text(const Grid& grid, const Density& density);

nlohmann::ordered_json bytes_by_type_json(const StreamInfo& info, std::uint64_t file_bytes);
std::string bytes_by_type_text(const StreamInfo& info, std::uint64_t file_bytes);

double bits_per_point(std::uint64_t bytes, std::uint64_t points);

/// What became of the points before they were coded.
nlohmann::ordered_json surface_json(const SurfaceReport& report);
std::string surface_text(const SurfaceReport& report);  ///< empty where nothing was asked

}  // namespace slf::tools
