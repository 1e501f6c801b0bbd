// SPDX-License-Identifier: Apache-2.0
// cameras.json: the shared convention. OpenCV axes, pixel centres at + 0.5, no distortion.
#include <cmath>
#include <map>

#include "capture/importer.h"
#include "capture/json.h"
#include "capture/json_numbers.h"

namespace slf {

namespace {

// K = [fx 0 cx; 0 fy cy; 0 0 1].
Result<Done, InputError> read_intrinsics(const JsonView& json, Camera& camera) {
  SLF_TRY(const auto k, (json_matrix<3, 3>(json)));
  if (std::abs(k[0][1]) > 1e-6 * std::abs(k[0][0]))
    return json.error("a skewed camera (K[0][1] = " + std::to_string(k[0][1]) +
                      ") is not supported: undistort the photographs to square axes");
  if (k[1][0] != 0 || k[2][0] != 0 || k[2][1] != 0 || k[2][2] != 1)
    return json.error("K is not of the form [fx 0 cx; 0 fy cy; 0 0 1]");
  camera.fx = k[0][0];
  camera.fy = k[1][1];
  camera.cx = k[0][2];
  camera.cy = k[1][2];
  return Done{};
}

Result<Camera, InputError> read_camera(const JsonView& json, std::string& mask) {
  Camera camera;
  SLF_TRY(const auto image, json.at("image"));
  SLF_TRY(camera.name, image.string());
  SLF_TRY(const auto width, json.at("width"));
  SLF_TRY(camera.width, json_size(width));
  SLF_TRY(const auto height, json.at("height"));
  SLF_TRY(camera.height, json_size(height));
  SLF_TRY(const auto k, json.at("K"));
  SLF_CHECK(read_intrinsics(k, camera));
  SLF_TRY(const auto r, json.at("R"));
  SLF_TRY(camera.rotation, (json_matrix<3, 3>(r)));
  SLF_TRY(const auto t, json.at("t"));
  SLF_TRY(camera.translation, json_vector<3>(t));
  if (const auto found = json.find("mask")) {
    SLF_TRY(mask, found->string());
  }
  return camera;
}

Result<std::vector<int>, InputError> read_split(const JsonView& json,
                                                const std::map<std::string, int>& camera_of) {
  SLF_TRY(const auto items, json.items());
  std::vector<int> split;
  std::vector<bool> taken(camera_of.size());
  for (const auto& item : items) {
    SLF_TRY(const auto name, item.string());
    const auto found = camera_of.find(name);
    if (found == camera_of.end()) return item.error("'" + name + "' is no image of the capture");
    if (taken[static_cast<std::size_t>(found->second)]) return item.error("'" + name + "' twice");
    taken[static_cast<std::size_t>(found->second)] = true;
    split.push_back(found->second);
  }
  return split;
}

Result<std::optional<UpAxis>, InputError> read_up(const JsonView& json) {
  using Up = std::optional<UpAxis>;
  static const std::map<std::string, UpAxis> axes{{"+x", UpAxis::kPlusX}, {"-x", UpAxis::kMinusX},
                                                  {"+y", UpAxis::kPlusY}, {"-y", UpAxis::kMinusY},
                                                  {"+z", UpAxis::kPlusZ}, {"-z", UpAxis::kMinusZ}};
  const auto up = json.find("up");
  if (!up) return Up{};
  SLF_TRY(const auto name, up->string());
  const auto axis = axes.find(name);
  if (axis == axes.end()) return up->error("'" + name + "' is none of +x, -x, +y, -y, +z, -z");
  return Up{axis->second};
}

}  // namespace

Result<Import, InputError> import_cameras_json(const std::filesystem::path& file) {
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const auto document, parse_json(file.string(), text));
  const JsonView json(document, file.string());
  SLF_TRY(const auto cameras, json.at("cameras"));
  SLF_TRY(const auto items, cameras.items());

  Import import;
  import.capture.root = file.parent_path();
  import.cloud_file = import.capture.root / "points.ply";
  if (const auto points = json.find("points")) {
    SLF_TRY(const auto name, points->string());
    import.cloud_label = file.string() + ": points";
    SLF_TRY(import.cloud_file, path_inside(import.capture.root, name, import.cloud_label));
  }
  std::map<std::string, int> camera_of;
  bool has_masks = false;
  for (std::size_t i = 0; i < items.size(); ++i) {
    std::string mask;
    SLF_TRY(Camera camera, read_camera(items[i], mask));
    if (!camera_of.emplace(camera.name, static_cast<int>(i)).second)
      return items[i].error("image '" + camera.name + "' twice");
    has_masks = has_masks || !mask.empty();
    import.images.push_back(camera.name);
    import.masks.push_back(mask);
    import.labels.push_back(file.string() + ": cameras[" + std::to_string(i) + "]");
    import.capture.cameras.push_back(std::move(camera));
  }
  if (!has_masks) import.masks.clear();
  if (const auto splits = json.find("splits")) {
    SLF_CHECK(splits->expect_object());
    for (const auto& [name, split] : splits->members()) {
      SLF_TRY(import.capture.splits[name], read_split(split, camera_of));
    }
  }
  SLF_TRY(import.up, read_up(json));
  return import;
}

}  // namespace slf
