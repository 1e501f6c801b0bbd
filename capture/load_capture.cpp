// SPDX-License-Identifier: Apache-2.0
// Which importer reads a path, where the cloud comes from, and the checks of the whole.
#include "capture/check_capture.h"
#include "capture/check_photographs.h"
#include "capture/colmap_workspace.h"
#include "capture/crop.h"
#include "capture/file_names.h"
#include "capture/foreign_captures.h"
#include "capture/frame_photographs.h"
#include "capture/importer.h"
#include "capture/json.h"
#include "capture/json_numbers.h"
#include "capture/mesh_formats.h"
#include "capture/mesh_sampling.h"
#include "capture/mesh_sides.h"
#include "capture/photograph_names.h"
#include "capture/ply_reader.h"
#include "capture/read_scan.h"
#include "capture/wkt.h"
#include "slf/frame_inputs.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

Result<Import, InputError> import_colmap(const fs::path& directory, const std::string& extension) {
  SLF_TRY(Import import,
          extension == ".bin" ? import_colmap_binary(directory) : import_colmap_text(directory));
  find_colmap_masks(import);
  if (!import.images.empty() && import.images.front().starts_with("images/"))
    count_other_photographs(import.capture.root / "images", import);
  return import;
}

// By content: any name will do for a JSON file.
Result<Import, InputError> import_json(const fs::path& file, const fs::path& images) {
  if (file.filename() == "cameras.json") return import_cameras_json(file);
  SLF_TRY(const auto text, read_file(file, kMaxJsonBytes));
  SLF_TRY(const auto document, parse_json(file.string(), text));
  const JsonView json(document, file.string());
  if (json.find("frames")) return import_transforms_json(file, images);
  if (json.find("cameras")) return import_cameras_json(file);
  if (json.find("sfm_data_version")) return import_openmvg(file);
  if (const std::string what = foreign_capture(file); !what.empty()) return json.error(what);
  return json.error("neither 'cameras' nor 'frames': not a capture");
}

Result<Import, InputError> import_file(const fs::path& file, const fs::path& images) {
  const std::string extension = extension_of(file);
  if (extension == ".json") return import_json(file, images);
  if (extension == ".cams") return import_index_cams(file, images);
  if (extension == ".out") return import_bundler(file, images);
  if (extension == ".xml") return import_metashape(file);
  const std::string stem = file.stem().string();
  const bool colmap = stem == "cameras" || stem == "images" || stem == "points3D";
  if (colmap && (extension == ".bin" || extension == ".txt"))
    return import_colmap(file.parent_path(), extension);
  if (extension == ".ply" || is_scan(file)) {
    Import import;
    import.capture.root = file.parent_path();
    import.cloud_file = file;
    return import;
  }
  const std::string what = foreign_capture(file);
  return InputError{
      Errc::kInvalidInput,
      file.string() + ": " + (what.empty() ? "not a capture that is understood" : what)};
}

Result<Import, InputError> import_found(const ColmapPlace& model) {
  SLF_TRY(Import import, import_colmap(model.directory, model.extension));
  if (!model.warning.empty()) import.capture.warnings.push_back(model.warning);
  return import;
}

Result<Import, InputError> import_directory(const fs::path& directory, const fs::path& images) {
  if (is_file(directory / "cameras.json")) return import_cameras_json(directory / "cameras.json");
  if (const auto model = find_colmap(directory)) return import_found(*model);
  if (is_file(directory / "transforms.json"))
    return import_transforms_json(directory / "transforms.json", images);
  if (is_file(directory / "transforms_train.json"))
    return import_transforms_splits(directory, images);
  if (const auto model = find_colmap(directory / "colmap")) return import_found(*model);
  if (is_file(directory / "index.cams")) return import_index_cams(directory / "index.cams", images);
  if (is_file(directory / "cameras.xml")) return import_metashape(directory / "cameras.xml");
  for (const char* name : {"bundle.out", "bundle.rd.out", "bundle/bundle.out"})
    if (is_file(directory / name)) return import_bundler(directory / name, images);
  if (is_file(directory / "sfm_data.json")) return import_openmvg(directory / "sfm_data.json");
  const std::string what = foreign_capture(directory);
  return InputError{Errc::kInvalidInput, directory.string() +
                                             ": not a capture: no cameras.json, COLMAP model or "
                                             "transforms.json" +
                                             (what.empty() ? "" : "; " + what)};
}

// The file that the format names, else one of a usual name; empty where there is none.
fs::path geometry_file(const Import& import) {
  if (!import.cloud_file.empty() && is_file(import.cloud_file)) return import.cloud_file;
  for (const char* name :
       {"points.ply", "points.laz", "points.las", "points.e57", "mesh.ply", "mesh.obj", "mesh.glb",
        "mesh.stl", "fused.ply", "meshed-poisson.ply", "meshed-delaunay.ply"})
    if (is_file(import.capture.root / name)) return import.capture.root / name;
  if (!import.points_file.empty()) return import.points_file;
  return import.cloud_file;
}

// Turns the mesh towards the cameras, and samples it as finely as all of them together resolve it.
Result<Done, InputError> sample_surface(const std::string& name, Mesh mesh, Capture& capture) {
  if (capture.cameras.empty()) {
    capture.warnings.push_back(name +
                               ": without cameras faces are ignored: its vertices are coded");
    capture.cloud = std::move(mesh.vertices);
    return Done{};
  }
  if (turn_towards(capture.cameras, mesh))
    capture.warnings.push_back(name + ": faces point inwards: they are turned");
  auto sampled = sample_for_cameras(capture, mesh);
  if (!sampled) return InputError{sampled.error().code, name + ": " + sampled.error().message};
  capture.cloud = *std::move(sampled);
  if (capture.cloud.positions.empty())
    return InputError{Errc::kInvalidInput, name + ": no face has an area that a camera resolves"};
  capture.mesh = std::move(mesh);
  return Done{};
}

// Turns normals of a cloud; faces of a mesh are turned before points are taken from them.
void turn_normals(const std::string& name, Capture& capture) {
  if (!capture.mesh.triangles.empty() || capture.cameras.empty()) return;
  const GivenNormals given = turn_towards(capture.cameras, capture.cloud);
  if (given == GivenNormals::kInwards)
    capture.warnings.push_back(name + ": normals point inwards: they are turned");
  if (given == GivenNormals::kEitherWay)
    capture.warnings.push_back(
        name + ": normals point either way: each is turned to the cameras that see it");
}

// What was read is given from the origin that its reader chose: so is everything else.
void take_origin(PointCloud& cloud, Capture& capture) {
  capture.origin = cloud.origin;
  cloud.origin = {0, 0, 0};
  const Vec3 back{-capture.origin[0], -capture.origin[1], -capture.origin[2]};
  for (Camera& camera : capture.cameras) camera = moved(std::move(camera), back);
}

// Leaves out what is not wanted; else says what perhaps is not.
Result<Done, InputError> crop_or_warn(const std::string& name, const CaptureOptions& options,
                                      Capture& capture, Mesh& mesh) {
  if (options.crop) {
    auto cropped = crop(mesh, capture.origin, *options.crop);
    if (!cropped) return InputError{cropped.error().code, name + ": " + cropped.error().message};
    return Done{};
  }
  const std::string warning = far_points_warning(mesh.vertices, capture.origin);
  if (!warning.empty()) capture.warnings.push_back(name + ": " + warning);
  return Done{};
}

// Reads the cloud or mesh, and what a scan says of its coordinates.
Result<Mesh, InputError> read_geometry(const fs::path& file, Capture& capture) {
  if (!is_scan(file)) return read_mesh(file, &capture.warnings);
  SLF_TRY(Scan scan, read_scan(file, &capture.warnings));
  SLF_CHECK(check_mesh(file.string(), scan.points));
  if (is_wkt(scan.crs)) capture.crs = std::move(scan.crs);
  return std::move(scan.points);
}

// Scanners' programs write it beside the cloud.
void take_crs(fs::path file, Capture& capture) {
  file.replace_extension(".prj");
  if (!is_file(file)) return;
  if (auto crs = read_crs(file))
    capture.crs = *std::move(crs);
  else
    capture.warnings.push_back(crs.error().message + ": ignored");
}

// Reads the cloud from where it is; returns its name for messages.
Result<std::string, InputError> load_cloud(const CaptureOptions& options, Import& import) {
  auto& capture = import.capture;
  const fs::path file = !options.points.empty() ? options.points : geometry_file(import);
  if (!file.empty()) {
    SLF_TRY(Mesh mesh, read_geometry(file, capture));
    take_crs(file, capture);
    take_origin(mesh.vertices, capture);
    SLF_CHECK(crop_or_warn(file.string(), options, capture, mesh));
    if (mesh.triangles.empty())
      capture.cloud = std::move(mesh.vertices);
    else
      SLF_CHECK(sample_surface(file.string(), std::move(mesh), capture));
    return file.string();
  }
  if (!import.cloud_name.empty() && is_file(import.cloud_name)) {
    take_origin(capture.cloud, capture);
    Mesh points{std::move(capture.cloud), {}};
    SLF_CHECK(crop_or_warn(import.cloud_name, options, capture, points));
    capture.cloud = std::move(points.vertices);
    return std::string(import.cloud_name);
  }
  return InputError{Errc::kUnreadable,
                    (capture.root / "points.ply").string() + ": the capture has no point cloud" +
                        (import.cloud_name.empty()
                             ? ""
                             : ", nor have its model (points3D.bin, .txt or .ply) and its dense "
                               "workspace (fused.ply); --points FILE names one")};
}

/// Is the geometry a PLY without vertices, and was that expected?
Result<bool, InputError> is_empty(const CaptureOptions& options, const Import& import) {
  const fs::path file = !options.points.empty() ? options.points : geometry_file(import);
  if (!options.may_be_empty || extension_of(file) != ".ply") return false;
  SLF_TRY(const std::uint64_t count, ply_vertices(file));
  return count == 0;
}

/// Photographs and cameras alone are enough for whoever asked.
bool may_lack_points(const CaptureOptions& options, const Import& import) {
  if (options.points_needed || !options.points.empty() || import.capture.cameras.empty())
    return false;
  const bool in_model = !import.cloud_name.empty() && !import.capture.cloud.positions.empty();
  return !in_model && !is_file(geometry_file(import));
}

// Photographs are in the capture, or in a folder that was named.
Result<Done, InputError> resolve_files(const fs::path& folder, std::optional<std::uint32_t> frame,
                                       Import& import) {
  auto& capture = import.capture;
  for (std::size_t i = 0; i < import.images.size(); ++i) {
    SLF_TRY(auto image, photograph_file(capture.root, import.images[i], folder,
                                        frame ? at_frame(capture.cameras[i].name, *frame)
                                              : capture.cameras[i].name,
                                        import.labels[i]));
    capture.image_files.push_back(std::move(image));
    if (import.masks.empty()) continue;
    fs::path mask;
    if (!import.masks[i].empty()) {
      SLF_TRY(mask, path_inside(capture.root, import.masks[i], import.labels[i]));
    }
    capture.mask_files.push_back(std::move(mask));
  }
  return Done{};
}

Result<Capture, InputError> load_any(const fs::path& given, const CaptureOptions& options,
                                     std::optional<std::uint32_t> frame) {
  std::error_code error;
  fs::path path = fs::absolute(given, error).lexically_normal();
  if (!path.has_filename()) path = path.parent_path();  // "name/"
  const auto status = fs::status(path, error);
  if (given.empty() || !fs::exists(status))
    return InputError{Errc::kUnreadable, given.string() + ": no such file or directory"};

  SLF_TRY(Import import, fs::is_directory(status) ? import_directory(path, options.images)
                                                  : import_file(path, options.images));
  const bool lone_cloud = import.labels.empty() && import.cloud_file == path;
  if (import.capture.cameras.empty() && !lone_cloud)
    return InputError{Errc::kInvalidInput, path.string() + ": the capture has no cameras"};
  SLF_CHECK(check_cameras(import));
  if (frame) SLF_CHECK(take_frame(*frame, import));
  SLF_CHECK(resolve_files(options.images, frame, import));
  if (options.check_images) SLF_CHECK(check_photographs(import.capture));
  if (options.cloud && may_lack_points(options, import)) {
    if (options.crop)
      return InputError{Errc::kInvalidInput, path.string() + ": crop: the capture has no points"};
    import.capture.warnings.push_back(path.string() + ": no points: photographs find them");
    import.capture.cloud = {};
  } else if (options.cloud) {
    SLF_TRY(const bool empty, is_empty(options, import));
    if (empty) {
      import.capture.cloud = {};
      return std::move(import.capture);
    }
    SLF_TRY(const auto cloud_name, load_cloud(options, import));
    SLF_CHECK(check_cloud(import.capture, cloud_name));
    turn_normals(cloud_name, import.capture);
    if (options.check_images) SLF_CHECK(check_masks(import.capture));
  }
  // Nothing is known of the world of a COLMAP model; the other formats mean z up unless their
  // photographs say otherwise.
  const UpAxis usual = import.cloud_name.empty() ? UpAxis::kPlusZ : UpAxis::kUnknown;
  import.capture.up = import.up ? *import.up : up_of(import.capture.cameras, usual);
  return std::move(import.capture);
}

}  // namespace

Result<Capture, InputError> load_capture(const fs::path& given, const CaptureOptions& options) {
  return load_any(given, options, std::nullopt);
}

Result<Capture, InputError> load_frame(const FrameInput& frame, const CaptureOptions& options) {
  return load_any(frame.path, options, frame.of_all ? std::optional(frame.number) : std::nullopt);
}

}  // namespace slf
