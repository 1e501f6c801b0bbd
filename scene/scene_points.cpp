#include "scene/scene_points.h"

#include "capture/voxelise.h"
#include "encoder/fit_capture.h"

namespace slf {
namespace {

/// Whether the cloud goes to the grid as it is.
bool is_ready(const Capture& capture, std::span<const int> cameras,
              const EncoderSettings& settings) {
  const bool needs_normals = !cameras.empty() || settings.normal_bits > 0;
  return capture.mesh.triangles.empty() && (!needs_normals || !capture.cloud.normals.empty());
}

}  // namespace

Result<ScenePoints, InputError> store_points(const Capture& capture, std::span<const int> cameras,
                                             const EncoderSettings& settings,
                                             const GridWanted& wanted,
                                             const std::filesystem::path& directory) {
  ScenePoints points;
  if (is_ready(capture, cameras, settings)) {  // nothing but the cloud is held
    SLF_TRY(points.grid, grid_of(capture.cloud, wanted.bits, wanted.voxel_size));
    SLF_TRY(points.stored, PointStore::write(directory, capture.cloud, points.grid));
    points.merged = capture.cloud.positions.size() - points.stored.points;
    return points;
  }
  EncoderSettings on_grid = settings;
  on_grid.grid_bits = wanted.bits;
  on_grid.voxel_size = wanted.voxel_size;
  SLF_TRY(const VoxelCloud cloud, voxelise_capture(capture, cameras, on_grid));
  SLF_TRY(points.stored, PointStore::write(directory, cloud));
  points.grid = cloud.grid;
  points.merged = cloud.merged;
  return points;
}

std::uint64_t memory_of_points(const Capture& capture, std::span<const int> cameras,
                               const EncoderSettings& settings) {
  constexpr std::uint64_t kSorted = 16, kTriple = 12, kColour = 3, kVoxels = 48, kTree = 24;
  const PointCloud& cloud = capture.cloud;
  std::uint64_t bytes = kTriple + kSorted;
  if (!cloud.normals.empty()) bytes += kTriple;
  if (!cloud.colours.empty()) bytes += kColour;
  if (!is_ready(capture, cameras, settings)) bytes += kVoxels + kTriple + kTree;
  return (std::uint64_t{64} << 20) + bytes * cloud.positions.size() +
         kTriple * (capture.mesh.triangles.size() + 3 * capture.mesh.vertices.positions.size());
}

}  // namespace slf
