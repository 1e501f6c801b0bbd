// SPDX-License-Identifier: Apache-2.0
// What stands around a COLMAP model: other models, photographs, masks, dense clouds.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "capture/importer.h"

namespace slf {

struct ColmapPlace {
  std::filesystem::path directory;
  std::string extension;  ///< ".bin" or ".txt"
  std::string warning;    ///< where there are other models: which is taken; or empty
};

/// The extension of the model's files that are in a directory.
std::optional<std::string> colmap_extension(const std::filesystem::path& directory);

/// The model in a directory, in sparse/ or in sparse/0, sparse/1, ...: of several the one with most
/// photographs.
std::optional<ColmapPlace> find_colmap(const std::filesystem::path& directory);

/// Photographs of the model, without reading the rest of it; 0 where the file is damaged.
std::size_t colmap_num_images(const std::filesystem::path& directory, const std::string& extension);
/// The same of images.txt.
std::size_t colmap_num_images_text(const std::filesystem::path& directory);

/// Masks by the names of the photographs, in masks/ beside images/: masks/NAME.png as COLMAP has
/// them (a.jpg.png), masks/NAME, or the name with .png in place of its extension. All or as many as
/// there are.
void find_colmap_masks(Import& import);

/// A warning of photographs in the images' folder that the model does not have.
void count_other_photographs(const std::filesystem::path& folder, Import& import);

}  // namespace slf
