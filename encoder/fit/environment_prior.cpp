// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/environment_prior.h"

#include <algorithm>

#include "encoder/fit/environment_projection.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {
namespace {

constexpr std::size_t kPriorGrain = 256;  // points

}  // namespace

std::array<float, 3> EnvironmentPrior::operator()(std::size_t p,
                                                  const std::array<float, 2>& direction) const {
  if (!light_) return {0, 0, 0};
  const bool reflected = directions_ == Directions::kReflected;
  return (*light_)(points_.position[p],
                   vector_of(reflected ? direction : to_local(points_.normal, p, direction)));
}

std::vector<float> EnvironmentPrior::along(const PointwiseObservations& seen, int threads) const {
  if (!light_) return {};
  std::vector<float> light(3 * seen.count());
  parallel_ranges(seen.points(), kPriorGrain, threads, [&](std::size_t begin, std::size_t end) {
    SeenRoom room;
    for (std::size_t p = begin; p < end; ++p) {
      float* to = light.data() + 3 * seen.first(p);
      for (const auto& direction : seen.of(p, room).direction) {
        const auto colour = (*this)(p, direction);
        to = std::copy(colour.begin(), colour.end(), to);
      }
    }
  });
  return light;
}

void EnvironmentPrior::project(const PointwiseObservations& seen, const DirectionRows& basis,
                               int threads, FittedRows& rows) const {
  auto outward = points_.normal;
  parallel_ranges(outward.size(), kPriorGrain, threads, [&](std::size_t begin, std::size_t end) {
    SeenRoom room;
    for (std::size_t p = begin; p < end; ++p) {
      double towards_cameras = 0;  // the cosine of the reflected direction is that of the view
      for (const auto& direction : seen.of(p, room).direction) {
        const Vec3 v = vector_of(direction);
        for (std::size_t a = 0; a < 3; ++a) towards_cameras += v[a] * double(outward[p][a]);
      }
      if (towards_cameras < 0)
        for (float& x : outward[p]) x = -x;
    }
  });
  project_environment(*light_, points_.position, outward, directions_, basis, threads, rows);
}

}  // namespace slf
