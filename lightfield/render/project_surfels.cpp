// SPDX-License-Identifier: Apache-2.0
// The splats of a cloud's discs in a camera.
#include <algorithm>

#include "lightfield/render/surfel_cloud.h"
#include "slf/parallel.h"

namespace slf {

std::vector<Splat> project_surfels(const SurfelCloud& cloud, const Camera& camera, int threads,
                                   const std::atomic<bool>* ended) {
  constexpr std::size_t kGrain = 4096;
  std::vector<Splat> splats(cloud.size());
  std::vector<std::size_t> counts((cloud.size() + kGrain - 1) / kGrain);
  parallel_ranges(cloud.size(), kGrain, threads, [&](std::size_t begin, std::size_t end) {
    if (is_ended(ended)) return;
    std::size_t next = begin;
    for (std::size_t p = begin; p < end; ++p) {
      const auto& n = cloud.normals[p];
      const Disc disc{cloud.centres[p], {n[0], n[1], n[2]}, cloud.radii[p], cloud.areas[p]};
      if (const auto splat = project_disc(camera, disc, static_cast<std::uint32_t>(p)))
        splats[next++] = *splat;
    }
    counts[begin / kGrain] = next - begin;
  });
  // Every range has left its splats at its own start.
  std::size_t total = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    const auto from = splats.begin() + static_cast<std::ptrdiff_t>(i * kGrain);
    if (total != i * kGrain)
      std::copy(from, from + static_cast<std::ptrdiff_t>(counts[i]),
                splats.begin() + static_cast<std::ptrdiff_t>(total));
    total += counts[i];
  }
  splats.resize(total);
  return splats;
}

}  // namespace slf
