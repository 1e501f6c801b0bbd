// SPDX-License-Identifier: Apache-2.0
// What the importers have in common. Each turns one format into an Import; load_capture picks the
// importer, reads the cloud and checks the whole.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "slf/capture.h"

namespace slf {

/// Cameras as a format has them, in our convention but not yet checked.
struct Import {
  Capture capture;                    ///< root, cameras, splits; cloud if the format carries points
  std::vector<std::string> images;    ///< [cameras] relative to root, as the format has them
  std::vector<std::string> masks;     ///< [cameras] or empty; "" where a camera has none
  std::vector<std::string> labels;    ///< [cameras] where each stands: "cameras.json: cameras[3]"
  std::filesystem::path cloud_file;   ///< the PLY the format names; or empty
  std::string cloud_label;            ///< where it is named; empty: it need not be there
  std::filesystem::path points_file;  ///< a cloud that is taken where there is no other; or empty
  std::string cloud_name;             ///< for messages: where capture.cloud came from
  std::optional<UpAxis> up;           ///< where the format says
};

/// The shared convention. @param file  cameras.json
Result<Import, InputError> import_cameras_json(const std::filesystem::path& file);

/// COLMAP models. @param directory  holds cameras, images, points3D
Result<Import, InputError> import_colmap_binary(const std::filesystem::path& directory);
Result<Import, InputError> import_colmap_text(const std::filesystem::path& directory);

/// transforms.json of instant-ngp, nerfstudio and NeRF's Blender scenes.
/// @param images  here and below, for sizes: a folder that photographs are in, or empty: where the
///                format has them
Result<Import, InputError> import_transforms_json(const std::filesystem::path& file,
                                                  const std::filesystem::path& images = {});
/// A scene in several files of one directory: transforms_train.json is the split "dense",
/// transforms_test.json "evaluation".
Result<Import, InputError> import_transforms_splits(const std::filesystem::path& directory,
                                                    const std::filesystem::path& images = {});

/// Cameras of the surface light fields of Wood et al. (Fish, Elephant). Sizes are those of the
/// photographs. @param file  index.cams
Result<Import, InputError> import_index_cams(const std::filesystem::path& file,
                                             const std::filesystem::path& images = {});

/// Cameras of Bundler, with its points. Photographs are those of list.txt, beside the file, its
/// folder or the photographs (of x.bundle.out, COLMAP's, x.list.txt), and give the sizes. @param
/// file  bundle.out
Result<Import, InputError> import_bundler(const std::filesystem::path& file,
                                          const std::filesystem::path& images = {});
/// Cameras of openMVG, with the points of its structure. @param file  sfm_data.json
Result<Import, InputError> import_openmvg(const std::filesystem::path& file);
/// Cameras of Metashape. Photographs are found by their labels. @param file  XML
Result<Import, InputError> import_metashape(const std::filesystem::path& file);

/// A warning of cameras without a pose.
void warn_of_left_out(const std::string& file, std::size_t left_out, std::size_t of,
                      Import& import);

/// Refuses an image or mask path that is empty or leads out of the capture.
/// @param label  for messages
/// @return the path, absolute and without "." and ".."
Result<std::filesystem::path, InputError> path_inside(const std::filesystem::path& root,
                                                      const std::string& relative,
                                                      const std::string& label);

}  // namespace slf
