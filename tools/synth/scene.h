// SPDX-License-Identifier: Apache-2.0
// What the ray tracer and the point sampler ask of a scene.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "slf/capture.h"
#include "tools/synth/vec.h"

namespace slf::synth {

/// What a photograph shows.
class Subject {
 public:
  virtual ~Subject() = default;

  /// Radius of a sphere around the origin that holds all that is seen; infinite: of every ray.
  virtual double radius() const = 0;

  /// Light that arrives along -ray.direction, and in `transmittance` the share of the background
  /// that shines through; false if the ray misses.
  virtual bool radiance(const Ray& ray, Colour& light, double& transmittance) const = 0;
};

/// A closed surface, around the origin, z up.
class Scene : public Subject {
 public:
  struct Bounds {
    Vec3 low, high;
    double radius;  ///< of a sphere around the origin
  };
  virtual Bounds bounds() const = 0;
  double radius() const override { return bounds().radius; }

  /// Points per largest extent of the default cloud: with 255 it is closed on an 8-bit grid.
  virtual int default_lattice() const = 0;

  /// All crossings of the line with the surface, in any order.
  virtual void crossings(const Ray& ray, std::vector<SurfacePoint>& out) const = 0;

  /// The surface as triangles; without any: the scene has none to offer.
  virtual Mesh mesh() const { return {}; }

  /// Diffuse colour of a surface point.
  virtual Colour albedo(const SurfacePoint& point) const = 0;
};

/// Segments of a circle in a mesh: the chord is off by less than 4e-5 of the radius.
inline constexpr std::uint32_t kMeshSegments = 360;

/// "can", "die", "vase"; null for any other name. The terrace is no closed surface: terrace.h.
std::unique_ptr<Scene> make_scene(const std::string& name);
/// All names, for messages: "can, die, vase, terrace".
std::string scene_names();

std::unique_ptr<Scene> make_can();
std::unique_ptr<Scene> make_die();
std::unique_ptr<Scene> make_vase();

}  // namespace slf::synth
