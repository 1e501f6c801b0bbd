// SPDX-License-Identifier: Apache-2.0
// One slice, from its units to integers. Spec 8.2.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "codec/decoder/decoder_state.h"
#include "slf/types.h"

namespace slf {

/// What the geometry of a slice leaves to its values.
struct SliceGeometry {
  std::vector<Voxel> positions = {};      ///< on the grid of request.levels bits
  std::vector<std::uint64_t> codes = {};  ///< of the nodes at `level`
  int level = 0;                          ///< that is known
  RahtTop top = {};  ///< of the kept rows, where there are values and all of the geometry
};

/// Where the integers of a slice go.
struct SliceOutput {
  std::span<const Voxel> positions;
  std::span<std::int32_t> components;               ///< [positions][3 R], zero before
  std::span<std::array<std::uint16_t, 2>> normals;  ///< [positions], where there are any
};

/// 8.4, 8.5: occupancy.
/// @param octree  of start_octree
Result<SliceGeometry> decode_slice_geometry(const SliceToDecode& slice, OccupancyStates octree);

/// 8.6 - 8.8, 8.10: coefficients and normals. Checks the digest, 7.9.
Result<Done> decode_slice_values(const SliceToDecode& slice, SliceGeometry geometry,
                                 const SliceOutput& output, int threads);

/// 8.11, of a slice whose planes are pictures. In slice_texture_decoder.cpp.
Result<Done> decode_slice_texture(const SliceToDecode& slice, const SliceGeometry& geometry,
                                  std::span<std::int32_t> components, int threads);

}  // namespace slf
