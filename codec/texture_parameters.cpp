#include "codec/texture_parameters.h"

#include <algorithm>

#include "geometry/morton.h"
#include "texture/atlas.h"

namespace slf {
namespace {

constexpr std::size_t kFewLoose = 16;  // one in so many points

/// Points outside charts over all slices; all of them where a texture would be too large.
std::size_t loose_points(std::span<const std::uint64_t> morton, const std::vector<SliceCut>& cuts,
                         int cell_log2) {
  std::size_t loose = 0;
  for (const SliceCut& cut : cuts) {
    const std::uint64_t inside = (std::uint64_t{1} << (3 * cut.header.slice_depth)) - 1;
    std::vector<std::uint64_t> local;
    for (std::size_t p = cut.begin; p < cut.end; ++p) local.push_back(morton[p] & inside);
    const auto atlas = derive_atlas(local, static_cast<int>(cut.header.slice_depth), cell_log2);
    loose += atlas ? atlas->num_loose : local.size();
  }
  return loose;
}

}  // namespace

int texture_cell_log2(std::span<const std::uint64_t> morton, const std::vector<SliceCut>& cuts) {
  int best = 0;
  std::size_t fewest = loose_points(morton, cuts, 0);
  for (int log2 = 1; log2 <= kMostCellLog2 && fewest >= morton.size() / kFewLoose; ++log2)
    if (const std::size_t loose = loose_points(morton, cuts, log2); loose < fewest) {
      fewest = loose;
      best = log2;
    }
  return best;
}

std::vector<std::uint32_t> least_texture_steps(std::span<const std::int32_t> components,
                                               std::size_t planes,
                                               const std::vector<SliceCut>& cuts, int bits) {
  const std::int64_t most = (std::int64_t{1} << bits) - 1;
  std::vector<std::uint32_t> steps(planes, 1);
  for (const SliceCut& cut : cuts) {
    const auto row = components.begin() + static_cast<std::ptrdiff_t>(cut.begin * planes);
    std::vector<std::int32_t> least(row, row + static_cast<std::ptrdiff_t>(planes)),
        greatest = least;
    for (std::size_t i = cut.begin * planes; i < cut.end * planes; ++i) {
      least[i % planes] = std::min(least[i % planes], components[i]);
      greatest[i % planes] = std::max(greatest[i % planes], components[i]);
    }
    for (std::size_t j = 0; j < planes; ++j) {
      const std::int64_t range = std::int64_t{greatest[j]} - least[j];
      steps[j] = std::max(steps[j], static_cast<std::uint32_t>((range + most - 1) / most));
    }
  }
  return steps;
}

std::vector<std::uint32_t> least_texture_steps(const LightField& field,
                                               std::uint32_t max_slice_points, int bits) {
  std::vector<std::uint64_t> codes;
  for (const Voxel& v : field.positions) codes.push_back(morton(v));
  return least_texture_steps(field.components, static_cast<std::size_t>(field.num_planes()),
                             cut_slices(codes, field.header.grid.bits, max_slice_points), bits);
}

}  // namespace slf
