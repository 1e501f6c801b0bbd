// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/environment_prior.h"

#include <algorithm>

#include "encoder/fit/environment_projection.h"
#include "lightfield/directions.h"
#include "slf/parallel.h"

namespace slf {

std::array<float, 3> EnvironmentPrior::operator()(std::size_t p,
                                                  const std::array<float, 2>& direction) const {
  if (!light_) return {0, 0, 0};
  const bool reflected = directions_ == Directions::kReflected;
  return (*light_)(points_.position[p],
                   vector_of(reflected ? direction : to_local(points_.normal, p, direction)));
}

std::vector<float> EnvironmentPrior::along(const Observations& seen, int threads) const {
  if (!light_) return {};
  constexpr std::size_t kGrain = 256;
  std::vector<float> light(3 * seen.direction.size());
  parallel_ranges(seen.first.size() - 1, kGrain, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      for (auto j = static_cast<std::size_t>(seen.first[p]); j < seen.first[p + 1]; ++j) {
        const auto colour = (*this)(p, seen.direction[j]);
        std::copy(colour.begin(), colour.end(), light.begin() + static_cast<std::ptrdiff_t>(3 * j));
      }
  });
  return light;
}

std::vector<float> EnvironmentPrior::projected(const Observations& seen, const DirectionRows& basis,
                                               int threads) const {
  const std::size_t points = points_.position.size();
  auto outward = points_.normal;
  for (std::size_t p = 0; p < points; ++p) {
    double towards_cameras = 0;  // the cosine of the reflected direction is that of the view
    for (auto j = seen.first[p]; j < seen.first[p + 1]; ++j) {
      const Vec3 v = vector_of(seen.direction[j]);
      for (std::size_t a = 0; a < 3; ++a) towards_cameras += v[a] * double(outward[p][a]);
    }
    if (towards_cameras < 0)
      for (float& x : outward[p]) x = -x;
  }
  return project_environment(*light_, points_.position, outward, directions_, basis, threads);
}

}  // namespace slf
