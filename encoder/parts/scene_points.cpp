// SPDX-License-Identifier: Apache-2.0
#include "encoder/parts/scene_points.h"

#include <optional>

#include "capture/mesh_parts.h"
#include "capture/mesh_triangles.h"

namespace slf {
namespace {

bool needs_normals(std::span<const int> cameras, const EncoderSettings& settings) {
  return !cameras.empty() || settings.normal_bits > 0;
}

Result<ScenePoints, InputError> store_mesh(const Mesh& mesh, const GridWanted& wanted,
                                           const std::filesystem::path& directory) {
  ScenePoints points;
  SLF_TRY(points.grid,
          choose_grid(bounding_box(mesh), mesh.triangles.size(), wanted.bits, wanted.voxel_size));
  SLF_TRY(points.stored, PointStore::write(directory, true, !mesh.vertices.colours.empty(),
                                           [&](const PointStore::Take& take) {
                                             return for_each_mesh_voxel(mesh, points.grid, take);
                                           }));
  return points;
}

}  // namespace

Result<ScenePoints, InputError> store_points(const Capture& capture, std::span<const int> cameras,
                                             const EncoderSettings& settings,
                                             const GridWanted& wanted,
                                             const std::filesystem::path& directory) {
  if (!capture.mesh.triangles.empty()) return store_mesh(capture.mesh, wanted, directory);
  std::optional<PointCloud> with_normals;
  if (needs_normals(cameras, settings) && capture.cloud.normals.empty()) {
    with_normals = capture.cloud;
    std::vector<Vec3> viewpoints;
    for (const Camera& camera : capture.cameras) viewpoints.push_back(camera.centre());
    with_normals->normals = estimate_normals(*with_normals, viewpoints, 16, settings.threads);
  }
  const PointCloud& cloud = with_normals ? *with_normals : capture.cloud;
  ScenePoints points;
  SLF_TRY(points.grid, grid_of(cloud, wanted.bits, wanted.voxel_size));
  SLF_TRY(points.stored,
          PointStore::write(directory, !cloud.normals.empty(), !cloud.colours.empty(),
                            [&](const PointStore::Take& take) -> Result<Done, InputError> {
                              for_each_voxel(cloud, points.grid, take);
                              return Done{};
                            }));
  points.merged = cloud.positions.size() - points.stored.points;
  return points;
}

std::uint64_t memory_of_points(const Capture& capture, std::span<const int> cameras,
                               const EncoderSettings& settings) {
  constexpr std::uint64_t kSorted = 16, kTriple = 12, kColour = 3, kTree = 24;
  constexpr std::uint64_t kProgram = std::uint64_t{64} << 20, kCube = std::uint64_t{256} << 20;
  const auto of_cloud = [](const PointCloud& cloud) {
    return kTriple * (cloud.positions.size() + cloud.normals.size()) +
           kColour * cloud.colours.size();
  };
  const std::uint64_t points = capture.cloud.positions.size();
  std::uint64_t bytes = kProgram + of_cloud(capture.cloud);
  if (const Mesh& mesh = capture.mesh; !mesh.triangles.empty())
    return bytes + kCube + of_cloud(mesh.vertices) + (kTriple + kSorted) * mesh.triangles.size();
  bytes += kSorted * points;
  if (needs_normals(cameras, settings) && capture.cloud.normals.empty())
    bytes += of_cloud(capture.cloud) + (kTriple + kTree) * points;
  return bytes;
}

}  // namespace slf
