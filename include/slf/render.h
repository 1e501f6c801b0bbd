// SPDX-License-Identifier: Apache-2.0
// Images from a light field, on the CPU.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "slf/capture.h"
#include "slf/view_map.h"

namespace slf {

struct RenderSettings {
  std::array<std::uint8_t, 3> background{128, 128, 128};
  double radius = 0;           ///< of a surfel in voxels; 0: from the cloud's own spacing
  bool view_dependent = true;  ///< false: the mean colour (function 0 alone)
  int threads = 0;
};

struct Rendering {
  Image image;                         ///< RGB, display values
  std::vector<std::uint8_t> coverage;  ///< [height][width] 0 .. 255: share of the pixel covered
  std::vector<float>
      depth;  ///< [height][width] along the optical axis, world units; +inf where nothing
};

/// The view that a file's metadata names (`view`, spec/registry.md): where a person looks first.
/// Nothing where it names none, or what is no view: seven finite numbers, two places, 1 to 170
/// degrees.
std::optional<Camera> named_view(const Metadata& metadata, UpAxis up, int width, int height);

struct SurfelCloud;

/// Surfel splatting: each point is a disc in the plane of its normal (coded, else estimated from
/// the voxels), drawn as an antialiased ellipse; a first pass fixes depth, a second blends what
/// lies within a surfel's thickness of it. A closed surface sampled at the pixel rate or denser has
/// no holes. Distortion of the camera is honoured at surfel centres. Deterministic for any thread
/// count. Several threads may render at a time. Gaussian splats (has_gaussians) are not discs:
/// GaussianRenderer draws them as annex E.6 says.
class Renderer {
 public:
  /// Precomputes normals and surfel radii; keeps a reference to `maps`. Of a grid that is no
  /// Grid::fits_floats() it draws the background alone.
  Renderer(const ViewMaps& maps, const RenderSettings& settings = {});
  /// O(points + pixels).
  /// @param ended  or none: where it is set meanwhile, work ends within some rows of the picture,
  ///               and the picture is not to be used: its arrays may be empty
  Rendering render(const Camera& camera, const std::atomic<bool>* ended = nullptr) const;

  /// A camera on a circle around the cloud, looking at its centre. turn: 0 .. 1; elevation in
  /// degrees above the plane across the up axis; the whole cloud fits into the image.
  Camera orbit(double turn, double elevation_degrees, int width, int height,
               double fov_degrees = 30) const;

 private:
  const ViewMaps& maps_;
  RenderSettings settings_;
  std::shared_ptr<const SurfelCloud> surfels_;
};

}  // namespace slf
