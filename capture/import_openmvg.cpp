// SPDX-License-Identifier: Apache-2.0
// openMVG's sfm_data.json: x_cam = R (x - center), x right, y down, z forward.
// Source: openMVG documentation, "SfM scene output format"; its camera models.
#include <map>
#include <utility>

#include "capture/exact_positions.h"
#include "capture/importer.h"
#include "capture/json.h"
#include "capture/json_numbers.h"
#include "capture/photograph_names.h"
#include "capture/radial_distortion.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

using Keyed = std::map<std::uint32_t, JsonView>;

/// What a shared pointer leads to, or the value itself.
Result<JsonView, InputError> data_of(const JsonView& value) {
  const auto pointer = value.find("ptr_wrapper");
  if (!pointer) return value;
  return pointer->at("data");
}

/// A member of an object, or of the base classes that stand in it as value0.
std::optional<JsonView> member(JsonView object, const char* name) {
  for (int depth = 0; depth < 8; ++depth) {
    if (auto found = object.find(name)) return found;
    const auto base = object.find("value0");
    if (!base) break;
    object = *base;
  }
  return std::nullopt;
}

Result<JsonView, InputError> needed(const JsonView& object, const char* name) {
  if (auto found = member(object, name)) return *std::move(found);
  return object.error(std::string("'") + name + "' is missing");
}

Result<std::uint32_t, InputError> id_of(const JsonView& json) {
  SLF_TRY(const double value, json.number());
  if (!(value >= 0 && value <= UINT32_MAX) || value != std::floor(value))
    return json.error("an id of 0 to 4294967295 is expected");
  return static_cast<std::uint32_t>(value);
}

/// A list of objects with key and value.
Result<Keyed, InputError> keyed(const JsonView& document, const char* name) {
  SLF_TRY(const JsonView list, document.at(name));
  SLF_TRY(const auto items, list.items());
  Keyed values;
  for (const JsonView& item : items) {
    SLF_TRY(const JsonView key, item.at("key"));
    SLF_TRY(const std::uint32_t id, id_of(key));
    SLF_TRY(const JsonView value, item.at("value"));
    SLF_TRY(JsonView data, data_of(value));
    if (!values.emplace(id, std::move(data)).second) return key.error("twice");
  }
  return values;
}

Result<Done, InputError> read_lens(const JsonView& intrinsic, const std::string& label,
                                   Camera& camera, double& worst) {
  RadialTerms radial{};
  if (const auto k1 = member(intrinsic, "disto_k1")) {
    SLF_TRY(const auto terms, json_vector<1>(*k1));
    radial[0] = terms[0];
  } else if (const auto k3 = member(intrinsic, "disto_k3")) {
    SLF_TRY(const auto terms, json_vector<3>(*k3));
    std::copy(terms.begin(), terms.end(), radial.begin());
  } else if (const auto brown = member(intrinsic, "disto_t2")) {  // k1 k2 k3 t1 t2
    SLF_TRY(const auto terms, json_vector<5>(*brown));
    std::copy(terms.begin(), terms.begin() + 3, radial.begin());
    camera.distortion[2] = terms[3];
    camera.distortion[3] = terms[4];
  }
  return set_radial(radial, label, camera, worst);
}

Result<Done, InputError> read_intrinsic(const JsonView& intrinsic, const std::string& label,
                                        Camera& camera, double& worst) {
  for (const char* other : {"fisheye", "disto_fisheye"})
    if (member(intrinsic, other))
      return intrinsic.error(
          "fisheye cameras are not supported: export undistorted "
          "photographs (openMVG_main_ExportUndistortedImages)");
  SLF_TRY(const JsonView width, needed(intrinsic, "width"));
  SLF_TRY(const JsonView height, needed(intrinsic, "height"));
  SLF_TRY(camera.width, json_size(width));
  SLF_TRY(camera.height, json_size(height));
  if (!member(intrinsic, "focal_length"))
    return intrinsic.error("no focal_length: cameras that are no pinholes are not supported");
  SLF_TRY(const JsonView focal, needed(intrinsic, "focal_length"));
  SLF_TRY(camera.fx, focal.number());
  camera.fy = camera.fx;
  if (!(camera.fx > 0)) return focal.error("the focal length is not positive");
  SLF_TRY(const JsonView principal, needed(intrinsic, "principal_point"));
  SLF_TRY(const auto centre, json_vector<2>(principal));
  camera.cx = centre[0];
  camera.cy = centre[1];
  return read_lens(intrinsic, label, camera, worst);
}

Result<Done, InputError> read_openmvg_pose(const JsonView& pose, Camera& camera) {
  SLF_TRY(const JsonView rotation, pose.at("rotation"));
  SLF_TRY(camera.rotation, (json_matrix<3, 3>(rotation)));
  SLF_TRY(const JsonView centre_json, pose.at("center"));
  SLF_TRY(const auto centre, json_vector<3>(centre_json));
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) camera.translation[i] -= camera.rotation[i][k] * centre[k];
  return Done{};
}

/// A view whose pose and lens are known; others are left out.
Result<Done, InputError> add_view(const JsonView& view, const Keyed& lenses, const Keyed& poses,
                                  const std::string& label, double& worst, Import& import) {
  SLF_TRY(const JsonView lens_json, needed(view, "id_intrinsic"));
  SLF_TRY(const JsonView pose_json, needed(view, "id_pose"));
  SLF_TRY(const std::uint32_t lens, id_of(lens_json));
  SLF_TRY(const std::uint32_t pose, id_of(pose_json));
  const auto its_lens = lenses.find(lens), its_pose = poses.find(pose);
  if (its_lens == lenses.end() || its_pose == poses.end()) return Done{};
  SLF_TRY(const JsonView name_json, needed(view, "filename"));
  SLF_TRY(const std::string name, name_json.string());
  std::string folder;
  if (const auto path = member(view, "local_path")) {
    SLF_TRY(folder, path->string());
  }
  if (!folder.empty() && !folder.ends_with('/')) folder += '/';
  Camera camera;
  camera.name = folder + name;
  SLF_CHECK(read_intrinsic(its_lens->second, label, camera, worst));
  SLF_CHECK(read_openmvg_pose(its_pose->second, camera));
  import.images.push_back(find_photograph(import.capture.root, camera.name));
  import.labels.push_back(label);
  import.capture.cameras.push_back(std::move(camera));
  return Done{};
}

/// The points of its structure, which have no colours.
Result<Done, InputError> read_structure(const JsonView& document, PointCloud& cloud) {
  if (!document.find("structure")) return Done{};
  SLF_TRY(const Keyed points, keyed(document, "structure"));
  std::vector<Vec3> positions;
  for (const auto& [key, point] : points) {
    SLF_TRY(const JsonView place, point.at("X"));
    SLF_TRY(const Vec3 position, json_vector<3>(place));
    positions.push_back(position);
  }
  set_positions(positions, cloud);
  return Done{};
}

}  // namespace

Result<Import, InputError> import_openmvg(const fs::path& file) {
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const auto value, parse_json(file.string(), text));
  const JsonView document(value, file.string() + " (openMVG)");
  SLF_TRY(const Keyed views, keyed(document, "views"));
  SLF_TRY(const Keyed lenses, keyed(document, "intrinsics"));
  SLF_TRY(const Keyed poses, keyed(document, "extrinsics"));
  Import import;
  import.capture.root = file.parent_path();
  double worst = 0;
  for (const auto& [key, view] : views)
    SLF_CHECK(add_view(view, lenses, poses, file.string() + ": view " + std::to_string(key), worst,
                       import));
  SLF_CHECK(read_structure(document, import.capture.cloud));
  import.cloud_name = file.string();
  if (auto warning = radial_warning(file.string(), worst); !warning.empty())
    import.capture.warnings.push_back(std::move(warning));
  warn_of_left_out(file.string(), views.size() - import.capture.cameras.size(), views.size(),
                   import);
  return import;
}

}  // namespace slf
