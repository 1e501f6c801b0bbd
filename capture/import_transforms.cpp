// SPDX-License-Identifier: Apache-2.0
// transforms.json: camera to world, OpenGL axes (x right, y up, looking along -z), corner pixels.
// Source: instant-ngp nerf_loader, nerfstudio data conventions, NeRF's Blender scenes.
#include <cmath>
#include <map>

#include "capture/importer.h"
#include "capture/json.h"
#include "capture/json_numbers.h"
#include "capture/photograph_names.h"
#include "capture/radial_distortion.h"
#include "capture/transforms_intrinsics.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

// Camera to world with OpenGL axes -> world to camera with OpenCV axes: the second and third column
// change sign, then R = C^T and t = -R c.
Result<Done, InputError> read_pose(const JsonView& json, Camera& camera) {
  SLF_TRY(const auto rows, json.items());
  if (rows.size() != 3 && rows.size() != 4) return json.error("3 or 4 rows are expected");
  std::array<std::array<double, 4>, 3> m{};
  for (std::size_t i = 0; i < 3; ++i) {
    SLF_TRY(m[i], json_vector<4>(rows[i]));
  }
  if (rows.size() == 4) {
    SLF_TRY(const auto last, json_vector<4>(rows[3]));
    if (last != std::array<double, 4>{0, 0, 0, 1}) return json.error("the last row is not 0 0 0 1");
  }
  constexpr std::array<double, 3> sign{1, -1, -1};
  for (std::size_t i = 0; i < 3; ++i) {
    camera.translation[i] = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      camera.rotation[i][j] = sign[i] * m[j][i];
      camera.translation[i] -= camera.rotation[i][j] * m[j][3];
    }
  }
  return Done{};
}

// The file that a path without extension stands for.
std::string with_extension(const fs::path& root, const std::string& path) {
  if (auto found = picture_named(root, path)) return *std::move(found);
  return fs::path(path).has_extension() ? path : path + ".png";
}

bool is_identity(const std::array<std::array<double, 4>, 3>& m) {
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 4; ++j)
      if (std::abs(m[i][j] - (i == j ? 1 : 0)) > 1e-9) return false;
  return true;
}

// nerfstudio writes the PLY it names in the world of the frames, so nothing is applied to it.
Result<Done, InputError> read_cloud(const JsonView& json, const fs::path& file, Import& import) {
  if (const auto ply = json.find("ply_file_path")) {
    SLF_TRY(const auto path, ply->string());
    import.cloud_label = file.string() + ": ply_file_path";
    SLF_TRY(import.cloud_file, path_inside(file.parent_path(), path, import.cloud_label));
    return Done{};
  }
  const auto applied = json.find("applied_transform");
  if (!applied) return Done{};
  SLF_TRY(const auto rows, applied->items());
  if (rows.size() == 4) return Done{};  // older files; 4 x 4
  SLF_TRY(const auto matrix, (json_matrix<3, 4>(*applied)));
  if (!is_identity(matrix))
    import.capture.warnings.push_back(
        file.string() +
        ": applied_transform: the cloud is taken to be in the world of the frames, after it");
  return Done{};
}

// Names of files in the document -> the split. Names are as in file_path.
Result<Done, InputError> read_named_split(const JsonView& json, const char* key, const char* split,
                                          const std::map<std::string, int>& camera_of,
                                          Import& import) {
  const auto names = json.find(key);
  if (!names || import.capture.splits.count(split) > 0) return Done{};
  SLF_TRY(const auto items, names->items());
  std::vector<int> cameras;
  for (const auto& item : items) {
    SLF_TRY(const auto name, item.string());
    const auto found = camera_of.find(name);
    if (found == camera_of.end()) return item.error("'" + name + "' is no frame");
    cameras.push_back(found->second);
  }
  if (!cameras.empty()) import.capture.splits[split] = std::move(cameras);
  return Done{};
}

// For all frames: where photographs are, or empty, and how far lenses miss, in pixels.
struct FrameInputs {
  const fs::path& images;
  double worst = 0;
};

Result<Done, InputError> add_frame(const JsonView& frame, const JsonView& document,
                                   const std::string& label, FrameInputs& inputs, Import& import) {
  Camera camera;
  SLF_TRY(const auto path_json, frame.at("file_path"));
  SLF_TRY(const auto path, path_json.string());
  // Before the file system is asked for anything under that name.
  SLF_CHECK(path_inside(import.capture.root, path, label));
  const std::string image = with_extension(import.capture.root, path);
  SLF_TRY(const auto file, path_inside(import.capture.root, image, label));
  camera.name =
      file.lexically_relative(fs::absolute(import.capture.root).lexically_normal()).string();
  SLF_TRY(auto size, read_transforms_size(frame, document));
  if (!size) {  // NeRF's Blender scenes leave it to the image
    SLF_TRY(const auto photograph,
            photograph_file(import.capture.root, image, inputs.images, camera.name, label));
    SLF_TRY(const auto actual, read_image_size(photograph));
    if (const auto problem = image_size_problem(actual))
      return InputError{Errc::kInvalidInput, photograph.string() + ": " + *problem};
    size = actual;
  }
  camera.width = static_cast<int>(size->width);
  camera.height = static_cast<int>(size->height);
  SLF_CHECK(read_transforms_intrinsics(frame, document, camera, inputs.worst));
  SLF_TRY(const auto matrix, frame.at("transform_matrix"));
  SLF_CHECK(read_pose(matrix, camera));
  std::string mask;
  if (const auto found = frame.find("mask_path")) {
    SLF_TRY(mask, found->string());
  }
  import.images.push_back(image);
  import.masks.push_back(mask);
  import.labels.push_back(label);
  import.capture.cameras.push_back(std::move(camera));
  return Done{};
}

// Adds the frames of a file; returns their cameras by file_path.
Result<std::map<std::string, int>, InputError> add_frames(const fs::path& file,
                                                          const fs::path& images, Import& import) {
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const auto value, parse_json(file.string(), text));
  const JsonView document(value, file.string());
  SLF_TRY(const auto frames_json, document.at("frames"));
  SLF_TRY(const auto frames, frames_json.items());
  std::map<std::string, int> camera_of;
  FrameInputs inputs{images};
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SLF_TRY(const auto path_json, frames[i].at("file_path"));
    SLF_TRY(const auto path, path_json.string());
    if (!camera_of.emplace(path, static_cast<int>(import.capture.cameras.size())).second)
      return frames[i].error("file_path '" + path + "' twice");
    const std::string label = file.string() + ": frames[" + std::to_string(i) + "]";
    SLF_CHECK(add_frame(frames[i], document, label, inputs, import));
  }
  if (const std::string warning = radial_warning(file.string(), inputs.worst); !warning.empty())
    import.capture.warnings.push_back(warning);
  SLF_CHECK(read_cloud(document, file, import));
  SLF_CHECK(read_named_split(document, "train_filenames", "dense", camera_of, import));
  SLF_CHECK(read_named_split(document, "test_filenames", "evaluation", camera_of, import));
  SLF_CHECK(read_named_split(document, "val_filenames", "evaluation", camera_of, import));
  return camera_of;
}

void drop_empty_masks(Import& import) {
  for (const auto& mask : import.masks)
    if (!mask.empty()) return;
  import.masks.clear();
}

}  // namespace

Result<Import, InputError> import_transforms_json(const fs::path& file, const fs::path& images) {
  Import import;
  import.capture.root = file.parent_path();
  SLF_CHECK(add_frames(file, images, import));
  drop_empty_masks(import);
  return import;
}

Result<Import, InputError> import_transforms_splits(const fs::path& directory,
                                                    const fs::path& images) {
  Import import;
  import.capture.root = directory;
  std::error_code error;
  for (const auto& [name, split] : {std::pair{"transforms_train.json", "dense"},
                                    std::pair{"transforms_test.json", "evaluation"}}) {
    if (!fs::exists(directory / name, error)) continue;
    const int first = static_cast<int>(import.capture.cameras.size());
    SLF_CHECK(add_frames(directory / name, images, import));
    auto& members = import.capture.splits[split];
    members.clear();
    for (int i = first; i < static_cast<int>(import.capture.cameras.size()); ++i)
      members.push_back(i);
  }
  drop_empty_masks(import);
  return import;
}

}  // namespace slf
