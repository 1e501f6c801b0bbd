// SPDX-License-Identifier: Apache-2.0
// The points of some cells of a scene, with those around them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "codec/encoder/scene_layout.h"
#include "encoder/parts/point_store.h"
#include "slf/capture.h"

namespace slf {

/// Where a scene is kept, and how it is divided into cells.
struct SceneCells {
  PointStore store;
  Grid grid;  ///< from Capture::origin
  SceneLayout layout;
  std::vector<std::uint64_t> first;  ///< [cells + 1] first point of each

  /// The points of a directory, on a grid; not laid out.
  /// @errors those of PointStore::open
  static Result<SceneCells, InputError> open(const std::filesystem::path& directory,
                                             const std::string& digest, std::uint64_t points,
                                             const Grid& grid);

  std::size_t count() const { return layout.cells.size(); }
  int cell_bits() const { return grid.bits - layout.base_levels; }
  /// The middle of a cell's cube, from Capture::origin.
  Vec3 middle(std::size_t cell) const;
  /// Radius of the sphere about it.
  double radius() const;
};

struct Region {
  VoxelCloud cloud;                ///< Morton order
  std::vector<std::uint32_t> own;  ///< points of the cells themselves, ascending

  std::vector<std::uint64_t> own_codes() const;
  /// [own][row] of [points][row].
  std::vector<float> own_rows(std::span<const float> of_all, std::size_t row) const;
};

/// @param cells   ascending
/// @param around  voxels: points of other cells as near as this to a cube of these come along; at
///                most the side of a cell
/// @errors kUnreadable
/// O(points of the cells and of those that touch them).
Result<Region, InputError> read_region(const SceneCells& scene, std::span<const std::size_t> cells,
                                       int around);

/// The positions of a cloud on its grid, from Capture::origin.
std::vector<std::array<float, 3>> positions_of(const SceneCells& scene,
                                               std::span<const std::uint64_t> codes);

}  // namespace slf
