// SPDX-License-Identifier: Apache-2.0
// Where photographs show the object at all: mending must not uncover what they show.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "capture/surface_points.h"
#include "encoder/refine/held_out.h"
#include "encoder/refine/offset_field.h"
#include "slf/capture.h"
#include "slf/error.h"

namespace slf {

/// Where a photograph shows what a cloud covers: as its difference from what stands behind.
struct Silhouette {
  const Camera* camera = nullptr;
  std::vector<std::uint8_t> difference;  ///< [height][width] root mean square of R, G, B; 0 where
                                         ///< the cloud is not; empty: nothing plain is behind it

  std::vector<std::uint8_t> object;  ///< [height][width] 1: the object by the photograph alone;
                                     ///< empty: it does not tell

  std::uint8_t at(const std::array<double, 2>& image) const;  ///< 0 outside
};

/// @param points  the cloud; beside its outlines is seen what stands behind
/// @errors those of load_image
Result<std::vector<Silhouette>, InputError> load_silhouettes(const Capture& capture,
                                                             std::span<const int> cameras,
                                                             const SurfacePoints& points,
                                                             double spacing, int threads);

/// [P] How far each point may move along its normal: where it makes an outline of the surface, it
/// makes that of the photograph. Farther in it would uncover the object, farther out hide what is
/// beside it. Points at no outline may move as they like.
std::vector<OffsetLimits> outline_limits(std::span<const Silhouette> silhouettes,
                                         const SurfacePoints& points, double spacing, int threads);

/// [P of before] What mending uncovers of the object, in the silhouettes' cameras: there the
/// picture shows what stands behind in place of the photograph. At the photograph's outline nothing
/// counts.
/// @param least  grey levels that a pixel of the object counts, where photographs tell: another
///               background shows what an object as grey as this one hides
HeldOutErrors uncovered_errors(std::span<const Silhouette> silhouettes, const SurfacePoints& before,
                               const SurfacePoints& after, double spacing, int threads,
                               std::uint8_t least = 0);

}  // namespace slf
