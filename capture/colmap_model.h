// SPDX-License-Identifier: Apache-2.0
// A COLMAP model, whichever of its two spellings it was read from.
// Source: COLMAP doc/format.rst and doc/cameras.rst.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/importer.h"

namespace slf {

/// A camera model. Parameters are in COLMAP's order.
struct ColmapModelKind {
  const char* name;
  std::size_t num_params;
  bool supported = false;  ///< of others an image is refused; a camera that none has does no harm
};

/// A camera model by COLMAP's number for it. @param label  for messages
/// @errors kInvalidInput: unknown
Result<ColmapModelKind, InputError> colmap_model_kind(std::int64_t id, const std::string& label);
Result<ColmapModelKind, InputError> colmap_model_kind(const std::string& name,
                                                      const std::string& label);

struct ColmapCamera {
  std::uint32_t id = 0;
  ColmapModelKind kind{};
  std::uint64_t width = 0, height = 0;
  std::vector<double> params;  ///< [kind.num_params]
  std::string label;           ///< for messages
};

struct ColmapImage {
  std::uint32_t id = 0;
  std::array<double, 4> quaternion{};  ///< w, x, y, z; world to camera
  Vec3 translation{};
  std::uint32_t camera = 0;  ///< id
  std::string name;
};

struct ColmapModel {
  std::vector<ColmapCamera> cameras;
  std::vector<ColmapImage> images;
  PointCloud points;                  ///< positions and colours; may be empty
  std::filesystem::path points_file;  ///< where they came from, or would have
};

/// points3D, in whichever spelling it is there; nothing where it is not.
/// @param extension  of the model, which is looked for first
Result<Done, InputError> read_colmap_points(const std::filesystem::path& directory,
                                            const std::string& extension, ColmapModel& model);
Result<PointCloud, InputError> read_colmap_points_binary(const std::filesystem::path& file);
Result<PointCloud, InputError> read_colmap_points_text(const std::filesystem::path& file);

/// Cameras in the order of the images' names: COLMAP writes them in no order.
/// @param extension  ".bin" or ".txt", for messages
Result<Import, InputError> import_of(ColmapModel model, const std::filesystem::path& directory,
                                     const std::string& extension);

}  // namespace slf
