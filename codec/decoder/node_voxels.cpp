// SPDX-License-Identifier: Apache-2.0
#include "codec/decoder/node_voxels.h"

#include <algorithm>

#include "base/multiversion.h"
#include "geometry/morton.h"

namespace slf {
namespace {

/// Coordinates of nodes to those of voxels: shifted up, to the middle of the node, and down.
SLF_MULTIVERSION
void to_voxels(std::span<const std::uint64_t> codes, int up, int down, Voxel* voxels) {
  const std::int32_t middle = (1 << up) >> 1;
  for (const std::uint64_t code : codes) {
    Voxel voxel = from_morton(code);
    for (auto& coordinate : voxel) coordinate = ((coordinate << up) + middle) >> down;
    *voxels++ = voxel;
  }
}

}  // namespace

std::vector<Voxel> node_voxels(std::span<const std::uint64_t> codes, int level,
                               const Request& request) {
  std::vector<Voxel> voxels(codes.size());
  to_voxels(codes, request.stream.grid_bits() - level, request.dropped_levels(), voxels.data());
  if (level > request.levels) voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

}  // namespace slf
