// SPDX-License-Identifier: Apache-2.0
#include "capture/colmap_model.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/quaternion.h"
#include "capture/file_names.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

// By number. Source: COLMAP src/colmap/sensor/models.h.
constexpr std::array<ColmapModelKind, 18> kModels{{{"SIMPLE_PINHOLE", 3, true},
                                                   {"PINHOLE", 4, true},
                                                   {"SIMPLE_RADIAL", 4, true},
                                                   {"RADIAL", 5, true},
                                                   {"OPENCV", 8, true},
                                                   {"OPENCV_FISHEYE", 8},
                                                   {"FULL_OPENCV", 12},
                                                   {"FOV", 5},
                                                   {"SIMPLE_RADIAL_FISHEYE", 4},
                                                   {"RADIAL_FISHEYE", 5},
                                                   {"THIN_PRISM_FISHEYE", 12},
                                                   {"RAD_TAN_THIN_PRISM_FISHEYE", 16},
                                                   {"SIMPLE_DIVISION", 4},
                                                   {"DIVISION", 5},
                                                   {"SIMPLE_FISHEYE", 3},
                                                   {"FISHEYE", 4},
                                                   {"EUCM", 6},
                                                   {"EQUIRECTANGULAR", 2}}};

void set_intrinsics(const ColmapCamera& from, Camera& to) {
  const auto& p = from.params;
  const std::string kind = from.kind.name;
  const bool one_focal = kind != "PINHOLE" && kind != "OPENCV";
  std::size_t at = 0;
  to.fx = p[at++];
  to.fy = one_focal ? to.fx : p[at++];
  to.cx = p[at++];
  to.cy = p[at++];
  // k; k1, k2; k1, k2, p1, p2: what is missing is zero.
  for (std::size_t i = 0; at < p.size(); ++i) to.distortion[i] = p[at++];
}

// The directory that image names are relative to: images/ beside the model, or beside sparse/ where
// the model is sparse/ or sparse/0. Where the first image is decides; where it is nowhere, the
// outermost.
struct Place {
  fs::path root;
  std::string prefix;  // "images/" or ""
};

Place place_of_images(const fs::path& directory, const std::string& first_image) {
  std::vector<fs::path> roots{directory};
  if (directory.parent_path().filename() == "sparse")
    roots.push_back(directory.parent_path().parent_path());
  if (directory.filename() == "sparse") roots.push_back(directory.parent_path());
  if (roots.back().filename() == "colmap") roots.push_back(roots.back().parent_path());
  std::error_code error;
  for (const auto& root : roots)
    for (const char* prefix : {"images/", ""})
      if (fs::exists(root / (prefix + first_image), error)) return {root, prefix};
  return {roots.back(), "images/"};
}

}  // namespace

Result<ColmapModelKind, InputError> colmap_model_kind(std::int64_t id, const std::string& label) {
  if (id >= 0 && static_cast<std::uint64_t>(id) < kModels.size())
    return kModels[static_cast<std::size_t>(id)];
  return InputError{Errc::kInvalidInput, label + ": unknown camera model " + std::to_string(id)};
}

Result<ColmapModelKind, InputError> colmap_model_kind(const std::string& name,
                                                      const std::string& label) {
  for (const auto& model : kModels)
    if (name == model.name) return model;
  return InputError{Errc::kInvalidInput, label + ": unknown camera model '" + name + "'"};
}

Result<Done, InputError> read_colmap_points(const fs::path& directory, const std::string& extension,
                                            ColmapModel& model) {
  const bool binary_first = extension == ".bin";
  model.points_file = directory / ("points3D" + extension);
  for (const bool binary : {binary_first, !binary_first}) {
    const fs::path file = directory / (binary ? "points3D.bin" : "points3D.txt");
    if (!is_file(file)) continue;
    model.points_file = file;
    SLF_TRY(model.points, binary ? read_colmap_points_binary(file) : read_colmap_points_text(file));
    return Done{};
  }
  return Done{};
}

Result<Import, InputError> import_of(ColmapModel model, const fs::path& directory,
                                     const std::string& extension) {
  const std::string cameras_file = (directory / ("cameras" + extension)).string();
  const std::string images_file = (directory / ("images" + extension)).string();
  const auto invalid = [](const std::string& where, const std::string& cause) {
    return InputError{Errc::kInvalidInput, where + ": " + cause};
  };
  std::map<std::uint32_t, const ColmapCamera*> camera_of;
  for (const auto& camera : model.cameras) {
    if (!camera_of.emplace(camera.id, &camera).second)
      return invalid(cameras_file, "camera " + std::to_string(camera.id) + " twice");
    if (camera.width < 1 || camera.height < 1 || camera.width > 65535 || camera.height > 65535)
      return invalid(cameras_file,
                     "camera " + std::to_string(camera.id) + ": image size out of range");
  }
  std::sort(model.images.begin(), model.images.end(),
            [](const auto& a, const auto& b) { return a.name < b.name; });

  Import import;
  const Place place =
      place_of_images(directory, model.images.empty() ? "" : model.images.front().name);
  import.capture.root = place.root;
  import.capture.cloud = std::move(model.points);
  import.cloud_name = model.points_file.string();
  if (is_file(directory / "points3D.ply")) import.points_file = directory / "points3D.ply";
  std::size_t not_unit = 0;
  for (std::size_t i = 0; i < model.images.size(); ++i) {
    auto& image = model.images[i];
    const std::string label = images_file + ": image '" + image.name + "'";
    if (i > 0 && image.name == model.images[i - 1].name) return invalid(label, "twice");
    const auto found = camera_of.find(image.camera);
    if (found == camera_of.end())
      return invalid(label, "there is no camera " + std::to_string(image.camera));
    if (!found->second->kind.supported)
      return invalid(found->second->label,
                     std::string("camera model ") + found->second->kind.name +
                         " is not supported; undistort the images to PINHOLE first");
    auto q = image.quaternion;
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!(length > 0) || !std::isfinite(length))
      return invalid(label, "rotation of length 0 or not finite");
    if (std::abs(length - 1) > 1e-6) ++not_unit;
    for (double& component : q) component /= length;

    Camera camera;
    camera.name = image.name;
    camera.width = static_cast<int>(found->second->width);
    camera.height = static_cast<int>(found->second->height);
    set_intrinsics(*found->second, camera);
    camera.rotation = rotation_of(q);
    camera.translation = image.translation;
    import.capture.cameras.push_back(std::move(camera));
    import.images.push_back(place.prefix + image.name);
    import.labels.push_back(label);
  }
  if (not_unit > 0)
    import.capture.warnings.push_back(images_file + ": " + std::to_string(not_unit) +
                                      " rotations are not of unit length: normalised");
  return import;
}

}  // namespace slf
