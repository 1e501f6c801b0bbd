// SPDX-License-Identifier: Apache-2.0
// Where the cloud or mesh of a capture comes from, and what is made of it.
#include "capture/load_cloud.h"

#include <algorithm>

#include "base/vec3.h"
#include "capture/change_world.h"
#include "capture/check_capture.h"
#include "capture/check_photographs.h"
#include "capture/crop.h"
#include "capture/file_names.h"
#include "capture/mesh_formats.h"
#include "capture/mesh_sampling.h"
#include "capture/mesh_sides.h"
#include "capture/mesh_triangles.h"
#include "capture/other_world.h"
#include "capture/ply_reader.h"
#include "capture/read_scan.h"
#include "capture/wkt.h"

namespace slf {

namespace {

namespace fs = std::filesystem;

constexpr int kLookBits = 6;  // of the sample of a mesh
constexpr std::size_t kLookPoints = 4000;

// The file that the format names, else one of a usual name; empty where there is none.
fs::path geometry_file(const Import& import) {
  if (!import.cloud_file.empty() && is_file(import.cloud_file)) return import.cloud_file;
  for (const char* name :
       {"points.ply", "points.laz", "points.las", "points.e57", "mesh.ply", "mesh.obj", "mesh.glb",
        "mesh.gltf", "mesh.stl", "fused.ply", "meshed-poisson.ply", "meshed-delaunay.ply"})
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

/// Points for a look at them, from the world's origin: of a mesh some of its surface.
std::vector<Vec3> looked_at_points(const Mesh& mesh, const Vec3& origin) {
  PointCloud sampled;
  if (!mesh.triangles.empty()) {
    const auto grid = choose_grid(bounding_box(mesh), 1, kLookBits, 0);
    if (!grid) return {};
    auto points = sample_mesh(mesh, *grid);
    if (!points) return {};
    sampled = *std::move(points);
  }
  const auto& positions = (mesh.triangles.empty() ? mesh.vertices : sampled).positions;
  const std::size_t stride = std::max<std::size_t>(positions.size() / kLookPoints, 1);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < positions.size(); i += stride) {
    out.push_back(to_double(positions[i]));
    for (std::size_t k = 0; k < 3; ++k) out.back()[k] += origin[k];
  }
  return out;
}

/// Says so where cloud and cameras are in different worlds.
/// @param hint  what would do, for an error of such a cloud
void look_at_world(const std::string& name, const CaptureOptions& options, const Mesh& mesh,
                   Capture& capture, std::string& hint) {
  if (!options.check_images || capture.cameras.empty()) return;
  const auto other = other_world(looked_at_points(mesh, capture.origin), capture);
  if (!other) return;
  hint = other->warning();
  capture.warnings.push_back(name + ": " + hint);
}

// Moves, crops and samples what was read.
Result<Done, InputError> take_geometry(const std::string& name, const CaptureOptions& options,
                                       Mesh mesh, Capture& capture, std::string& hint) {
  if (options.world) change_world(*options.world, mesh);
  take_origin(mesh.vertices, capture);
  SLF_CHECK(crop_or_warn(name, options, capture, mesh));
  look_at_world(name, options, mesh, capture, hint);
  if (!mesh.triangles.empty()) return sample_surface(name, std::move(mesh), capture);
  capture.cloud = std::move(mesh.vertices);
  return Done{};
}

// Reads the cloud from where it is; name: for messages.
Result<Done, InputError> load_cloud(const CaptureOptions& options, Import& import,
                                    std::string& name, std::string& hint) {
  auto& capture = import.capture;
  const fs::path file = !options.points.empty() ? options.points : geometry_file(import);
  if (!file.empty()) {
    name = file.string();
    SLF_TRY(Mesh mesh, read_geometry(file, capture));
    take_crs(file, capture);
    return take_geometry(name, options, std::move(mesh), capture, hint);
  }
  if (!import.cloud_name.empty() && is_file(import.cloud_name)) {
    name = import.cloud_name;
    Mesh points{std::move(capture.cloud), {}};
    return take_geometry(name, options, std::move(points), capture, hint);
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

/// The cloud, and whether it can be meant.
Result<Done, InputError> load_and_check(const CaptureOptions& options, Import& import,
                                        std::string& name, std::string& hint) {
  SLF_CHECK(load_cloud(options, import, name, hint));
  return check_cloud(import.capture, name);
}

}  // namespace

Result<Done, InputError> load_geometry(const std::string& path, const CaptureOptions& options,
                                       Import& import) {
  Capture& capture = import.capture;
  if (options.points.empty() && !import.cloud_label.empty() && !is_file(import.cloud_file))
    return InputError{Errc::kUnreadable,
                      import.cloud_label + ": " + import.cloud_file.string() + ": no such file"};
  if (may_lack_points(options, import)) {
    if (options.crop)
      return InputError{Errc::kInvalidInput, path + ": crop: the capture has no points"};
    capture.warnings.push_back(path + ": no points: photographs find them");
    capture.cloud = {};
    capture.has_geometry = false;
    return Done{};
  }
  SLF_TRY(const bool empty, is_empty(options, import));
  if (empty) {
    capture.cloud = {};
    return Done{};
  }
  std::string name, hint;
  if (auto done = load_and_check(options, import, name, hint); !done)
    return InputError{done.error().code, done.error().message + (hint.empty() ? "" : "; " + hint)};
  turn_normals(name, capture);
  if (options.check_images) SLF_CHECK(check_masks(capture));
  return Done{};
}

}  // namespace slf
