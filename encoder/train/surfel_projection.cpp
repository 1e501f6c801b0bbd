// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/surfel_projection.h"

#include <algorithm>

#include "base/multiversion.h"
#include "encoder/train/projection_lanes.h"

namespace slf {
namespace {

using ProjectedColumns = std::array<Lanes, 16>;
static_assert(sizeof(ProjectedSurfel) == sizeof(ProjectedColumns) / kLaneCount);

/// @param first  index of the first of them
[[gnu::always_inline]] inline void store(const Projections& p, const LaneMask& seen,
                                         std::size_t first, std::span<ProjectedSurfel> to) {
  const LaneMask index = std::int32_t(first) + LaneMask{0, 1, 2, 3, 4, 5, 6, 7};
  Lanes surfel;  // bits of an integer
  std::memcpy(&surfel, &index, sizeof index);
  const ProjectedColumns columns = {p.u,          p.v,           p.a,
                                    p.b,          p.c,           p.reach,
                                    p.half_width, p.half_height, seen ? p.opacity : Lanes{},
                                    p.colour[0],  p.colour[1],   p.colour[2],
                                    p.near,       p.near_du,     p.near_dv,
                                    surfel};
  std::array<float*, kLaneCount> rows{};
  for (std::size_t i = 0; i < to.size(); ++i) rows[i] = reinterpret_cast<float*>(&to[i]);
  store_rows(columns, rows, to.size());
}

SLF_MULTIVERSION_LANES void project_range(const TrainedSurfel* surfels, std::size_t begin,
                                          std::size_t end, const TrainingCamera& camera,
                                          ProjectedSurfel* projected) {
  for (std::size_t i = begin; i < end; i += kLaneCount) {
    const std::size_t count = std::min(kLaneCount, end - i);
    SurfelRows rows;
    for (std::size_t k = 0; k < kLaneCount; ++k)
      rows[k] = surfels[i + std::min(k, count - 1)].value.data();
    Projections p;
    LaneMask seen = set_centres(rows, camera, p);
    if (any(seen)) seen &= set_ellipse(camera, p);
    if (any(seen)) {
      set_colour(camera, p);
      set_plane(camera, p);
    }
    store(p, seen, i, {projected + i, count});
  }
}

}  // namespace

void project_trained(std::span<const TrainedSurfel> surfels, std::size_t begin, std::size_t end,
                     const TrainingCamera& camera, std::span<ProjectedSurfel> projected) {
  project_range(surfels.data(), begin, end, camera, projected.data());
}

}  // namespace slf
