// SPDX-License-Identifier: Apache-2.0
// Which cameras see what of a scene, and how much of their photographs is needed for it.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "encoder/parts/region.h"
#include "slf/capture.h"
#include "slf/scene.h"

namespace slf {

/// Whether something within the sphere may be in the image. Never wrongly false.
bool may_see(const Camera& camera, const Vec3& middle, double radius);

/// The cameras among `cameras` that may see one of the cells.
std::vector<int> cameras_of(const Capture& capture, std::span<const int> cameras,
                            const SceneCells& scene, std::span<const std::size_t> cells);

/// [cameras of the capture] log2 of how much smaller photographs may be: a pixel spans at most
/// half a spacing on what is nearest to its camera. O(cameras cells).
std::vector<int> choose_reduction(const Capture& capture, std::span<const int> cameras,
                                  const SceneCells& scene, double spacing);

/// The cameras of a capture, from the plan's origin and as small as it has them.
/// @param cache  bytes of photographs that are kept
Capture scene_cameras(const Capture& capture, const ScenePlan& plan, std::uint64_t cache);

/// SHA-256, hexadecimal, of what tells captures of other photographs apart without reading these:
/// calibrations from an origin, as floats, since machines differ in last digits of doubles, and
/// sizes of files.
std::string digest_of_photographs(const Capture& capture, const Vec3& origin);

/// Bytes of photographs to keep beside the work on a slice.
std::uint64_t cache_of(const ScenePlan& plan, const SceneWork& work);

}  // namespace slf
