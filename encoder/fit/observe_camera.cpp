// SPDX-License-Identifier: Apache-2.0
#include "encoder/fit/observe_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "capture/object_mask.h"
#include "lightfield/colour.h"
#include "slf/view_map.h"

namespace slf {
namespace {

/// The two samples around coordinate x (in samples, their centres at integers) and the second's
/// weight.
struct Between {
  int first, second;
  double weight;
};

Between between(double x, int size) {
  const double low = std::floor(x);
  const int first = static_cast<int>(low);
  return {std::clamp(first, 0, size - 1), std::clamp(first + 1, 0, size - 1), x - low};
}

}  // namespace

std::array<float, 256> transfer_table(Transfer transfer) {
  std::array<float, 256> table{};
  for (int i = 0; i < 256; ++i) {
    const double value = transfer == Transfer::kLinear ? 255 * srgb_to_linear(i / 255.0) : i;
    table[static_cast<std::size_t>(i)] = static_cast<float>(value);
  }
  return table;
}

double least_cosine(double delta_degrees) {
  return std::sin(delta_degrees * std::numbers::pi / 180);
}

double view_cosine(const std::array<float, 3>& position, const std::array<float, 3>& normal,
                   const Vec3& centre) {
  double along_normal = 0, squared = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double to_camera = centre[a] - static_cast<double>(position[a]);
    along_normal += to_camera * static_cast<double>(normal[a]);
    squared += to_camera * to_camera;
  }
  return along_normal / std::sqrt(squared);
}

bool sample_bilinear(const Image& image, double u, double v, const std::array<float, 256>& transfer,
                     std::array<float, 3>& colour) {
  const Between x = between(u - 0.5, image.width), y = between(v - 0.5, image.height);
  std::array<double, 3> sum{0, 0, 0};
  for (const auto& [row, row_weight] : {std::pair{y.first, 1 - y.weight}, {y.second, y.weight}})
    for (const auto& [column, column_weight] :
         {std::pair{x.first, 1 - x.weight}, {x.second, x.weight}}) {
      const double weight = row_weight * column_weight;
      if (weight == 0) continue;
      const std::size_t pixel =
          static_cast<std::size_t>(row) * static_cast<std::size_t>(image.width) +
          static_cast<std::size_t>(column);
      const std::uint8_t* sample =
          image.data.data() + pixel * static_cast<std::size_t>(image.channels);
      if (image.channels == 4 && !shows_object(sample[3])) return false;
      for (std::size_t c = 0; c < 3; ++c)
        sum[c] += weight * static_cast<double>(transfer[sample[c]]);
    }
  for (std::size_t c = 0; c < 3; ++c) colour[c] = static_cast<float>(sum[c]);
  return true;
}

CameraObserver::CameraObserver(const ObservedPoints& points, const ObserveSettings& settings)
    : points_(points),
      min_cosine_(least_cosine(settings.delta_degrees)),
      transfer_(transfer_table(settings.transfer)) {}

CameraSightings CameraObserver::observe(const Camera& camera, const Image& image,
                                        const DepthBuffer& depth_buffer) const {
  CameraSightings seen;
  const Vec3 centre = camera.centre();
  for (std::size_t p = 0; p < points_.positions.size(); ++p) {
    const auto& position = points_.positions[p];
    const auto& normal = points_.normals[p];
    const double cosine = view_cosine(position, normal, centre);
    if (!(cosine >= min_cosine_)) continue;  // also a point at the camera's centre, and NaN
    ++seen.counts.facing;
    double depth = 0;
    const auto at = camera.project({position[0], position[1], position[2]}, &depth);
    if (!at ||
        !((*at)[0] >= 0 && (*at)[0] < camera.width && (*at)[1] >= 0 && (*at)[1] < camera.height))
      continue;
    ++seen.counts.inside;
    if (depth_buffer.hides(*at, depth, cosine)) continue;
    ++seen.counts.visible;
    Sighting sighting{static_cast<std::uint32_t>(p), {}, {}};
    if (!sample_bilinear(image, (*at)[0], (*at)[1], transfer_, sighting.colour)) continue;
    sighting.direction =
        direction_of({centre[0] - double(position[0]), centre[1] - double(position[1]),
                      centre[2] - double(position[2])});
    seen.sightings.push_back(sighting);
  }
  return seen;
}

}  // namespace slf
