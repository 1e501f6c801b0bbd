// SPDX-License-Identifier: Apache-2.0
// What one camera sees of the points. Paper III-A: field of view, occlusion, cone, interpolation.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "encoder/fit/observe_depth.h"
#include "slf/capture.h"
#include "slf/fit.h"

namespace slf {

struct Sighting {
  std::uint32_t point = 0;
  std::array<float, 2> direction{};  ///< (theta, gamma) of the vector from the point to the camera
  std::array<float, 3> colour{};     ///< 0 .. 255
};

/// How many points passed each test; each counts those that passed the ones before.
struct SightingCounts {
  std::uint64_t facing = 0, inside = 0, visible = 0;

  SightingCounts& operator+=(const SightingCounts& other) {
    facing += other.facing;
    inside += other.inside;
    visible += other.visible;
    return *this;
  }
};

struct CameraSightings {
  std::vector<Sighting> sightings;  ///< points ascending
  SightingCounts counts;
};

/// Keeps references to its arguments. Thread-safe: const after construction.
class CameraObserver {
 public:
  CameraObserver(const ObservedPoints& points, const ObserveSettings& settings);

  /// @param image  of the camera's size, 3 or 4 channels
  CameraSightings observe(const Camera& camera, const Image& image,
                          const DepthBuffer& depth_buffer) const;

 private:
  const ObservedPoints& points_;
  double min_cosine_;
  std::array<float, 256> transfer_;  // 8-bit sample to 0 .. 255 of the chosen transfer
};

/// 8-bit display values to 0 .. 255 of a transfer.
std::array<float, 256> transfer_table(Transfer transfer);

/// sin(delta): the least cosine between normal and view for the view to be valid.
double least_cosine(double delta_degrees);

/// Cosine between the normal (unit) and the direction to a camera's centre; NaN at the centre.
double view_cosine(const std::array<float, 3>& position, const std::array<float, 3>& normal,
                   const Vec3& centre);

/// Bilinear interpolation at image point (u, v), pixel centres at + 0.5, edges repeated; false
/// where a pixel that contributes is masked (shows_object).
/// @param transfer  applied to the samples before they are mixed
bool sample_bilinear(const Image& image, double u, double v, const std::array<float, 256>& transfer,
                     std::array<float, 3>& colour);

}  // namespace slf
