// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/pointwise_observations.h"

#include "lightfield/directions.h"

namespace slf {

SeenPoint PointwiseObservations::of(std::size_t point, SeenRoom& room) const {
  if (make_) return make_(point, room);
  const std::size_t at = first(point), n = count(point);
  return {std::span(kept_->direction).subspan(at, n), std::span(kept_->colour).subspan(at, n),
          std::span(kept_->camera).subspan(at, n)};
}

PointwiseObservations PointwiseObservations::mirrored_at(
    std::span<const std::array<float, 3>> normals) const {
  if (normals.empty()) return *this;
  PointwiseObservations mirrored = *this;
  mirrored.make_ = [world = *this, normals](std::size_t point, SeenRoom& room) {
    SeenPoint seen = world.of(point, room);
    if (seen.direction.data() != room.direction.data())
      room.direction.assign(seen.direction.begin(), seen.direction.end());
    for (auto& d : room.direction) d = to_local(normals, point, d);
    seen.direction = room.direction;
    return seen;
  };
  return mirrored;
}

}  // namespace slf
