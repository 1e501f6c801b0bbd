#include "codec/node_voxels.h"

#include "base/multiversion.h"
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

namespace {

SLF_MULTIVERSION
void from_mortons(std::span<const std::uint64_t> codes, Voxel* voxels) {
  for (const std::uint64_t code : codes) *voxels++ = from_morton(code);
}

}  // namespace

std::vector<Voxel> node_voxels(std::span<const std::uint64_t> codes, int level,
                               const SequencePlan& plan) {
  std::vector<Voxel> voxels;
  if (level == plan.levels && level == plan.grid_bits()) {
    voxels.resize(codes.size());
    from_mortons(codes, voxels.data());
    return voxels;
  }
  for (const std::uint64_t code : codes)
    if (const Voxel v = node_voxel(code, level, plan); voxels.empty() || v != voxels.back())
      voxels.push_back(v);
  return voxels;
}

}  // namespace slf
