// SPDX-License-Identifier: Apache-2.0
// One frame of a moving scene: its photographs and its points.
#pragma once

#include <vector>

#include "tools/synth/moving_scene.h"
#include "tools/synth/scene.h"
#include "tools/synth/triangle_tree.h"

namespace slf::synth {

/// A point of a part that stays on its material in all frames.
struct MaterialSample {
  std::uint32_t part;
  SurfacePoint at_rest;
  Colour albedo;
};

/// Samples of all parts, about one in a square of `spacing`.
std::vector<MaterialSample> material_samples(const MovingScene& scene, double spacing);
/// The spacing that gives about so many.
double spacing_of(const MovingScene& scene, double points);

/// What photographs of a frame show.
class MovingFrame final : public Subject {
 public:
  /// @param scene  kept by reference
  MovingFrame(const MovingScene& scene, int frame, int threads);

  double radius() const override { return scene_.radius; }
  bool radiance(const Ray& ray, Colour& light, double& transmittance) const override;

 private:
  struct Place {
    std::uint32_t part;
    std::array<std::uint32_t, 3> corners;  ///< of its mesh
  };
  const MovingScene& scene_;
  std::vector<std::vector<Vec3>> normals_;  ///< [parts][vertices], as they are turned now
  std::vector<Place> places_;               ///< [triangles] of the tree
  TriangleTree tree_{{}};
};

/// Samples of the parts that are there, but for those within other parts: where they are, and the
/// display colours of their diffuse ones. The same for any number of threads.
PointCloud moved_cloud(const MovingScene& scene, const std::vector<MaterialSample>& samples,
                       int frame, int threads);

}  // namespace slf::synth
