// SPDX-License-Identifier: Apache-2.0
#include "encoder/train/surface_pull.h"

#include "capture/nearest.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr float kSoft = 0.5f;        // pixels: nearer to a plane, the pull fades
constexpr float kLeastAgree = 0.5f;  // cosine between normals: others are of another surface

struct SurfelPlane {
  Float3 position, normal;
};

/// Derivative of sqrt(x^2 + soft^2).
float slope_at(float x) { return x / std::sqrt(x * x + kSoft * kSoft); }

}  // namespace

SurfelNeighbours surfel_neighbours(const TrainedSurfels& surfels, int threads) {
  constexpr int kWithItself = int(SurfelNeighbours::kCount) + 1;
  SurfelNeighbours out;
  if (surfels.size() < std::size_t(kWithItself)) return out;
  std::vector<Float3> positions;
  for (const TrainedSurfel& surfel : surfels) positions.push_back(surfel.position());
  const NearestPoints nearest(positions);
  out.index.resize(surfels.size() * SurfelNeighbours::kCount);
  parallel_ranges(surfels.size(), 512, threads, [&](std::size_t begin, std::size_t end) {
    std::array<std::uint32_t, std::size_t(kWithItself)> found{};
    for (std::size_t i = begin; i < end; ++i) {
      nearest.nearest(positions[i], kWithItself, found.data(), nullptr);
      std::size_t k = 0;
      for (const std::uint32_t j : found)
        if (j != i && k < SurfelNeighbours::kCount)
          out.index[i * SurfelNeighbours::kCount + k++] = j;
    }
  });
  return out;
}

void pull_together(const SurfelNeighbours& neighbours, float weight, float pixel, int threads,
                   const TrainedSurfels& surfels, std::vector<TrainedSurfel>& gradients) {
  if (neighbours.index.empty()) return;
  std::vector<SurfelPlane> planes(surfels.size());
  parallel_ranges(surfels.size(), 2048, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      planes[i] = {surfels[i].position(), axes_of(surfels[i]).normal};
  });
  parallel_ranges(surfels.size(), 1024, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto& [position, normal] = planes[i];
      Float3 by_position{}, by_normal{};
      for (std::size_t k = 0; k < SurfelNeighbours::kCount; ++k) {
        const SurfelPlane& other = planes[neighbours.index[i * SurfelNeighbours::kCount + k]];
        const float agree = dot(normal, other.normal);
        if (agree < kLeastAgree) continue;
        const Float3 to = minus(other.position, position);
        // The other's distance from this plane, and this one's from the other's.
        const float from_own = weight * agree * slope_at(dot(normal, to) / pixel) / pixel;
        const float from_other = weight * agree * slope_at(-dot(other.normal, to) / pixel) / pixel;
        by_position = along(along(by_position, -from_own, normal), from_other, other.normal);
        by_normal = along(by_normal, from_own, to);
      }
      for (std::size_t a = 0; a < 3; ++a)
        gradients[i].value[TrainedSurfel::kPosition + a] += by_position[a];
      add_turn_gradient(surfels[i], {{}, {}, by_normal}, &gradients[i].value[TrainedSurfel::kTurn]);
    }
  });
}

}  // namespace slf
