#include "codec/node_voxels.h"

#include "geometry/morton.h"

namespace slf {

Voxel node_voxel(std::uint64_t code, int level, const SequencePlan& plan) {
  const int below = plan.grid_bits() - level;
  const std::int32_t middle = below > 0 ? 1 << (below - 1) : 0;
  Voxel voxel = from_morton(code);
  for (auto& coordinate : voxel)
    coordinate = ((coordinate << below) + middle) >> plan.dropped_levels();
  return voxel;
}

std::vector<Voxel> node_voxels(std::span<const std::uint64_t> codes, int level,
                               const SequencePlan& plan) {
  std::vector<Voxel> voxels;
  voxels.reserve(level == plan.levels ? codes.size() : 0);
  for (const std::uint64_t code : codes)
    if (const Voxel v = node_voxel(code, level, plan); voxels.empty() || v != voxels.back())
      voxels.push_back(v);
  return voxels;
}

}  // namespace slf
